//! Entity filters: by name, category, tags and bounds; an entity must pass all of them.

use regex::RegexBuilder;

use super::{Simulator, bounds::Volume, entities::Entity, failed, named_poses::has_tags};
use crate::wire::messages::simulation_interfaces::{
    EntityFilters, Result as SimResult, TagsFilter,
};

/// Largest size of a compiled name filter (bytes); matching always takes linear time.
const REGEX_BYTES_MAX: usize = 1 << 18;
/// Largest length of a name filter (characters).
const FILTER_MAX: usize = 1000;

impl Simulator {
    /// The entities that pass the filters, in the same order.
    ///
    /// # Errors
    /// The result to respond with, if a filter is invalid.
    pub(super) fn filtered(
        &self,
        entities: Vec<Entity>,
        filters: &EntityFilters,
    ) -> Result<Vec<Entity>, SimResult> {
        if FILTER_MAX < filters.filter.len() {
            let reason = format!("the name filter has more than {FILTER_MAX} characters");
            return Err(failed(SimResult::RESULT_OPERATION_FAILED, reason));
        }
        let name = RegexBuilder::new(&filters.filter).size_limit(REGEX_BYTES_MAX).build();
        let name = name.map_err(|error| {
            let reason =
                format!("filter `{}` is not a regular expression: {error}", filters.filter);
            failed(SimResult::RESULT_OPERATION_FAILED, reason)
        })?;
        let volume = Volume::of_filter(&filters.bounds)
            .map_err(|reason| failed(SimResult::RESULT_OPERATION_FAILED, reason))?;
        if TagsFilter::FILTER_MODE_ALL < filters.tags.filter_mode {
            let reason = format!("there is no tags filter mode {}", filters.tags.filter_mode);
            return Err(failed(SimResult::RESULT_OPERATION_FAILED, reason));
        }
        let passes = |entity: &Entity| {
            let info = self.entity_table.get(&entity.name);
            name.is_match(&entity.name)
                && (filters.categories.is_empty() || filters.categories.contains(&info.category))
                && has_tags(&info.tags, &filters.tags)
                && volume.as_ref().is_none_or(|volume| volume.overlaps(&entity.volume()))
        };
        Ok(entities.into_iter().filter(passes).collect())
    }
}
