//! Reads triangle meshes from STL and OBJ files. Vertices are merged; the surface must be closed.

use std::{collections::BTreeMap, fs::File, io::BufReader, path::Path};

use crate::base::{Real, Vec3};

/// A closed surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Surface {
    /// Vertices (m).
    pub vertices: Vec<Vec3>,
    /// Vertex indices of each triangle, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Why a mesh file cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(super) enum MeshError {
    /// The file cannot be opened.
    #[error("cannot be opened: {reason}")]
    Unreadable {
        /// The message of the operating system.
        reason: String,
    },
    /// The format is not supported.
    #[error("is neither .stl nor .obj")]
    UnknownFormat,
    /// Built without the feature that reads meshes.
    #[cfg(not(feature = "meshes"))]
    #[error("needs a build with feature `meshes`")]
    NoFeature,
    /// The file is malformed.
    #[cfg(feature = "meshes")]
    #[error("cannot be read as a mesh: {reason}")]
    Malformed {
        /// The message of the parser.
        reason: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("has a vertex that is not finite")]
    NotFinite,
    /// The mesh has too few triangles.
    #[error("has {n_triangles} non-degenerate triangles; a closed surface needs at least 4")]
    Empty {
        /// Number of non-degenerate triangles.
        n_triangles: usize,
    },
    /// An edge is not shared by exactly two triangles of the same orientation.
    #[error(
        "is not closed: {n_edges} edges are not shared by two triangles of the same orientation"
    )]
    NotClosed {
        /// Number of such edges.
        n_edges: usize,
    },
}

/// Reads a mesh; one unit of the file is `unit` meters. If all triangles face inward, their
/// orientation is reversed.
///
/// # Errors
/// If the file is missing or malformed or its surface is not closed.
pub(super) fn read(file: &Path, unit: Real) -> Result<Surface, MeshError> {
    let extension = file.extension().and_then(|it| it.to_str()).unwrap_or("").to_lowercase();
    let corners = match extension.as_str() {
        "stl" => read_stl(file)?,
        "obj" => read_obj(file)?,
        _ => return Err(MeshError::UnknownFormat),
    };
    if corners.iter().flatten().flatten().any(|it| !it.is_finite()) {
        return Err(MeshError::NotFinite);
    }
    let mut surface = weld(&corners, unit);
    if surface.triangles.len() < 4 {
        return Err(MeshError::Empty { n_triangles: surface.triangles.len() });
    }
    let n_edges = unmatched_edges(&surface.triangles);
    if n_edges != 0 {
        return Err(MeshError::NotClosed { n_edges });
    }
    if volume(&surface) < 0.0 {
        surface.triangles.iter_mut().for_each(|it| it.swap(1, 2));
    }
    Ok(surface)
}

type Corners = Vec<[[f32; 3]; 3]>;

fn open(file: &Path) -> Result<BufReader<File>, MeshError> {
    File::open(file)
        .map(BufReader::new)
        .map_err(|error| MeshError::Unreadable { reason: error.to_string() })
}

#[cfg(not(feature = "meshes"))]
fn read_stl(file: &Path) -> Result<Corners, MeshError> {
    open(file)?;
    Err(MeshError::NoFeature)
}

#[cfg(not(feature = "meshes"))]
fn read_obj(file: &Path) -> Result<Corners, MeshError> {
    read_stl(file)
}

#[cfg(feature = "meshes")]
fn read_stl(file: &Path) -> Result<Corners, MeshError> {
    let mut reader = open(file)?;
    let mesh = stl_io::read_stl(&mut reader)
        .map_err(|error| MeshError::Malformed { reason: error.to_string() })?;
    let point = |index: usize| {
        let vertex = mesh.vertices[index];
        [vertex[0], vertex[1], vertex[2]]
    };
    Ok(mesh.faces.iter().map(|face| face.vertices.map(point)).collect())
}

#[cfg(feature = "meshes")]
fn read_obj(file: &Path) -> Result<Corners, MeshError> {
    let options = tobj::LoadOptions { triangulate: true, ..Default::default() };
    // Material files hold only colors, which are not used.
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut open(file)?, &options, no_materials)
        .map_err(|error| MeshError::Malformed { reason: error.to_string() })?;
    let mut corners = Vec::new();
    for model in &models {
        let points: Vec<[f32; 3]> =
            model.mesh.positions.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        for triangle in model.mesh.indices.chunks_exact(3) {
            corners.push([0, 1, 2].map(|k| points[triangle[k] as usize]));
        }
    }
    Ok(corners)
}

/// Merges corners that are equal to the last bit and drops triangles that become degenerate.
fn weld(corners: &Corners, unit: Real) -> Surface {
    let mut index_of: BTreeMap<[u32; 3], u32> = BTreeMap::new();
    let mut surface = Surface { vertices: Vec::new(), triangles: Vec::new() };
    for triangle in corners {
        let ids = triangle.map(|point| {
            // Adding zero turns -0 into +0.
            let bits = point.map(|it| (it + 0.0).to_bits());
            *index_of.entry(bits).or_insert_with(|| {
                let [x, y, z] = point.map(Real::from);
                surface.vertices.push(Vec3::new(x, y, z) * unit);
                u32::try_from(surface.vertices.len() - 1).expect("mesh files count in 32 bits")
            })
        });
        if ids[0] != ids[1] && ids[1] != ids[2] && ids[2] != ids[0] {
            surface.triangles.push(ids);
        }
    }
    surface
}

/// Number of edges that are not used exactly once in each direction.
fn unmatched_edges(triangles: &[[u32; 3]]) -> usize {
    let mut balance: BTreeMap<(u32, u32), (u32, u32)> = BTreeMap::new();
    for triangle in triangles {
        for k in 0..3 {
            let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
            let (forward, backward) = balance.entry((from.min(to), from.max(to))).or_default();
            if from < to { *forward += 1 } else { *backward += 1 }
        }
    }
    balance.values().filter(|it| **it != (1, 1)).count()
}

/// Enclosed volume (m³); negative if the triangles face inward.
fn volume(surface: &Surface) -> Real {
    let p = |index: u32| surface.vertices[index as usize];
    let six = |t: &[u32; 3]| p(t[0]).dot(&p(t[1]).cross(&p(t[2])));
    surface.triangles.iter().map(six).sum::<Real>() / 6.0
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

    fn obj(faces: &str) -> Result<Surface, MeshError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.obj");
        File::create(&path).unwrap().write_all(format!("{TETRAHEDRON}{faces}").as_bytes()).unwrap();
        read(&path, 1e-3)
    }

    /// Oracle: volume of the unit tetrahedron, 1/6, in mm³.
    #[test]
    fn both_orientations_become_outward() {
        let outward = obj("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n").unwrap();
        let inward = obj("f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n").unwrap();
        for surface in [outward, inward] {
            let expected = 1e-9 / 6.0;
            assert!((volume(&surface) - expected).abs() < 1e-12 * expected, "{surface:?}");
        }
    }

    #[test]
    fn open_and_twisted_surfaces_are_rejected() {
        let open = obj("f 1 3 2\nf 1 2 4\nf 1 4 3\n");
        assert_eq!(open, Err(MeshError::Empty { n_triangles: 3 }));
        let twisted = obj("f 1 2 3\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
        assert_eq!(twisted, Err(MeshError::NotClosed { n_edges: 3 }));
    }
}
