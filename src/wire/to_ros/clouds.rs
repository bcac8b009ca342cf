//! Grains and membrane as point clouds, and the membrane as a surface.
//!
//! A row of a cloud is a plain struct of 32-bit numbers, so the bytes of a cloud are its rows.

use bytemuck::{Pod, Zeroable};

use super::{MEMBRANE, WORLD, parts};
use crate::{
    base::Vec3,
    snapshot::{GrainsSnapshot, MembraneSnapshot},
    wire::messages::{
        geometry_msgs::{Point, Pose, Quaternion, Vector3},
        sensor_msgs::{PointCloud2, PointField},
        shape_msgs::{Mesh, MeshTriangle},
        std_msgs::ColorRGBA,
        visualization_msgs::Marker,
    },
};

/// One grain: 36 bytes.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct GrainRow {
    position: [f32; 3],
    radius: f32,
    velocity: [f32; 3],
    normal_force: f32,
    id: u32,
}

/// One vertex of the membrane: 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct VertexRow {
    position: [f32; 3],
    normal: [f32; 3],
    pressure: f32,
    strain: f32,
}

const GRAIN_FIELDS: [(&str, u8); 9] = [
    ("x", PointField::FLOAT32),
    ("y", PointField::FLOAT32),
    ("z", PointField::FLOAT32),
    ("radius", PointField::FLOAT32),
    ("vx", PointField::FLOAT32),
    ("vy", PointField::FLOAT32),
    ("vz", PointField::FLOAT32),
    ("fn", PointField::FLOAT32),
    ("id", PointField::UINT32),
];

const VERTEX_FIELDS: [(&str, u8); 8] = [
    ("x", PointField::FLOAT32),
    ("y", PointField::FLOAT32),
    ("z", PointField::FLOAT32),
    ("normal_x", PointField::FLOAT32),
    ("normal_y", PointField::FLOAT32),
    ("normal_z", PointField::FLOAT32),
    ("pressure", PointField::FLOAT32),
    ("strain", PointField::FLOAT32),
];

/// The grains; only every k-th if there are more than `count_max`.
pub(super) fn grains(grains: &GrainsSnapshot, count_max: usize, time_ns: u64) -> PointCloud2 {
    let stride = grains.positions.len().div_ceil(count_max.max(1)).max(1);
    let rows: Vec<GrainRow> = (0..grains.positions.len())
        .step_by(stride)
        .map(|i| GrainRow {
            position: singles(&grains.positions[i]),
            radius: single(grains.radii[i]),
            velocity: singles(&grains.velocities[i]),
            normal_force: single(grains.normal_forces[i]),
            id: u32::try_from(i).unwrap_or(u32::MAX),
        })
        .collect();
    cloud(&rows, &GRAIN_FIELDS, time_ns)
}

/// The vertices of the membrane, in mesh order.
pub(super) fn membrane(membrane: &MembraneSnapshot, time_ns: u64) -> PointCloud2 {
    let rows: Vec<VertexRow> = (0..membrane.positions.len())
        .map(|i| VertexRow {
            position: singles(&membrane.positions[i]),
            normal: singles(&membrane.normals[i]),
            pressure: single(membrane.contact_pressures[i]),
            strain: single(membrane.strains[i]),
        })
        .collect();
    cloud(&rows, &VERTEX_FIELDS, time_ns)
}

#[expect(clippy::cast_possible_truncation, reason = "clouds are in single precision")]
fn single(value: f64) -> f32 {
    value as f32
}

fn singles(v: &Vec3) -> [f32; 3] {
    [single(v.x), single(v.y), single(v.z)]
}

fn cloud<Row: Pod>(rows: &[Row], fields: &[(&str, u8)], time_ns: u64) -> PointCloud2 {
    let row_bytes = size_of_u32::<Row>();
    let width = u32::try_from(rows.len()).expect("a cloud has fewer than 2^32 points");
    let field = |(offset, &(name, datatype)): (u32, &(&str, u8))| PointField {
        name: name.to_owned(),
        offset,
        datatype,
        count: 1,
    };
    PointCloud2 {
        header: parts::header(time_ns, WORLD),
        height: 1,
        width,
        fields: (0..).step_by(4).zip(fields).map(field).collect(),
        is_bigendian: cfg!(target_endian = "big"),
        point_step: row_bytes,
        row_step: row_bytes * width,
        data: bytemuck::cast_slice(rows).to_vec(),
        is_dense: true,
    }
}

fn size_of_u32<T>() -> u32 {
    u32::try_from(size_of::<T>()).expect("a row is a few bytes long")
}

/// Triangles and vertices of the membrane at rest, in the frame `membrane`.
pub(super) fn mesh(triangles: &[[u32; 3]], vertices: &[Vec3]) -> Mesh {
    Mesh {
        triangles: triangles
            .iter()
            .map(|&vertex_indices| MeshTriangle { vertex_indices })
            .collect(),
        vertices: vertices.iter().map(parts::point).collect(),
    }
}

/// The membrane as a surface for RViz. Its points are rounded to single precision, which is enough
/// for display and compresses better.
pub(super) fn surface(membrane: &MembraneSnapshot, triangles: &[[u32; 3]], time_ns: u64) -> Marker {
    let rounded = |v: &Vec3| Point {
        x: f64::from(single(v.x)),
        y: f64::from(single(v.y)),
        z: f64::from(single(v.z)),
    };
    let corners = triangles.iter().flatten();
    Marker {
        header: parts::header(time_ns, WORLD),
        ns: MEMBRANE.to_owned(),
        r#type: Marker::TRIANGLE_LIST,
        action: Marker::ADD,
        pose: Pose {
            orientation: Quaternion { w: 1.0, ..Default::default() },
            ..Default::default()
        },
        scale: Vector3 { x: 1.0, y: 1.0, z: 1.0 },
        color: ColorRGBA { r: 0.85, g: 0.45, b: 0.2, a: 0.5 },
        points: corners.map(|&i| rounded(&membrane.positions[i as usize])).collect(),
        ..Default::default()
    }
}
