//! Which entities a question means: by name, category, tags and place, all at once.

use regex::RegexBuilder;

use super::{Simulator, bounds::Volume, entities::Entity, failed};
use crate::wire::messages::simulation_interfaces::{
    EntityFilters, EntityInfo, Result as SimResult, TagsFilter,
};

/// Memory that a name filter may take when compiled; matching takes linear time in any case.
const REGEX_BYTES_MAX: usize = 1 << 18;
/// Characters that a name filter may have.
const FILTER_MAX: usize = 1000;

impl Simulator {
    /// The entities that pass, in their order.
    ///
    /// # Errors
    /// If a filter makes no sense; the result to answer with.
    pub(super) fn filtered(
        &self,
        entities: Vec<Entity>,
        filters: &EntityFilters,
    ) -> Result<Vec<Entity>, SimResult> {
        if FILTER_MAX < filters.filter.len() {
            let why = format!("the name filter has more than {FILTER_MAX} characters");
            return Err(failed(SimResult::RESULT_OPERATION_FAILED, why));
        }
        let name = RegexBuilder::new(&filters.filter).size_limit(REGEX_BYTES_MAX).build();
        let name = name.map_err(|error| {
            let why = format!("filter `{}` is no regular expression: {error}", filters.filter);
            failed(SimResult::RESULT_OPERATION_FAILED, why)
        })?;
        let place = Volume::of_filter(&filters.bounds)
            .map_err(|why| failed(SimResult::RESULT_OPERATION_FAILED, why))?;
        if TagsFilter::FILTER_MODE_ALL < filters.tags.filter_mode {
            let why = format!("there is no tags filter mode {}", filters.tags.filter_mode);
            return Err(failed(SimResult::RESULT_OPERATION_FAILED, why));
        }
        let passes = |entity: &Entity| {
            let info = self.register.get(&entity.name);
            name.is_match(&entity.name)
                && (filters.categories.is_empty() || filters.categories.contains(&info.category))
                && has_tags(&info, &filters.tags)
                && place.as_ref().is_none_or(|place| place.overlaps(&entity.volume()))
        };
        Ok(entities.into_iter().filter(passes).collect())
    }
}

fn has_tags(info: &EntityInfo, filter: &TagsFilter) -> bool {
    let has = |tag: &String| info.tags.contains(tag);
    filter.tags.is_empty()
        || match filter.filter_mode {
            TagsFilter::FILTER_MODE_ALL => filter.tags.iter().all(has),
            _ => filter.tags.iter().any(has),
        }
}
