//! Point clouds and curves as legacy VTK files, which ParaView and PyVista read.

use super::error::ReportError;
use super::manifold::{ManifoldCurve, is_drawable};
use super::result_files::write_text;
use crate::workspace::SpatialShareMap;
use std::path::Path;
use vtkio::model::{
    Attribute, Attributes, ByteOrder, DataSet, PolyDataPiece, Version, VertexNumbers, Vtk,
};

/// Name of a report's point cloud.
pub(super) const POINTS: &str = "points.vtk";

/// Decimals of coordinates, metres: below every cell, and the same text on every machine.
const DECIMALS: f64 = 1e9;

/// Writes the middles of all cells with a fault-tolerant share above 0 as points (x, y, z) in
/// metres with the scalars `share` and `unrestricted` in [0, 1]: a legacy VTK file in ASCII.
/// Cells are in the map's order. The file appears whole or not at all; missing directories are
/// created.
///
/// # Errors
/// If the file cannot be written.
pub fn write_points(map: &SpatialShareMap, path: &Path) -> Result<(), ReportError> {
    let (mut places, mut shares, mut unrestricted) = (Vec::new(), Vec::new(), Vec::new());
    for ir in 0..map.radii() {
        for iz in 0..map.heights() {
            for k in 0..map.azimuths {
                let share = map.share_at(ir, iz, k);
                if share > 0.0 {
                    let (r, azimuth) = (map.radius(ir), map.azimuth(k));
                    let place = [r * azimuth.cos(), r * azimuth.sin(), map.height(iz)];
                    places.extend(place.map(|c| (c * DECIMALS).round() / DECIMALS + 0.0));
                    shares.push(share as f32);
                    unrestricted.push(map.unrestricted_at(ir, iz) as f32);
                }
            }
        }
    }
    let count = shares.len() as u32;
    // ParaView shows points only where a cell holds them.
    let vertices = (0..count).flat_map(|k| [1, k]).collect();
    let piece = PolyDataPiece {
        points: places.into(),
        verts: Some(VertexNumbers::Legacy {
            num_cells: count,
            vertices,
        }),
        data: Attributes {
            point: vec![
                scalars("share", shares),
                scalars("unrestricted", unrestricted),
            ],
            cell: Vec::new(),
        },
        ..PolyDataPiece::default()
    };
    write("shares of a fault-tolerant workspace, metres", piece, path)
}

/// Writes self-motion manifolds as polylines in the space of the three joints numbered `joints`
/// (from 1), in degrees and not wrapped, with the number of the curve as the scalar `manifold`: a
/// legacy VTK file in ASCII. Vertices without such joints are left out, and the last vertex of a
/// closed curve is not joined with the first, from which it may be whole turns away.
///
/// # Errors
/// If the file cannot be written.
pub fn write_curves(
    curves: &[ManifoldCurve],
    joints: [usize; 3],
    path: &Path,
) -> Result<(), ReportError> {
    let (mut places, mut lines, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
    for (k, curve) in curves.iter().enumerate() {
        let vertices = curve.points.iter().filter_map(|point| {
            let angle = |joint: usize| point.get(joint.checked_sub(1)?).copied();
            let [a, b, c] = joints.map(angle);
            let seen = [a?, b?, c?];
            is_drawable(&seen, 3).then(|| seen.map(f64::to_degrees))
        });
        let vertices: Vec<[f64; 3]> = vertices.collect();
        if vertices.len() > 1 {
            let first = numbers.len();
            lines.push(vertices.len() as u32);
            lines.extend((first..first + vertices.len()).map(|index| index as u32));
            numbers.extend(vertices.iter().map(|_| k as i32 + 1));
            places.extend(vertices.into_iter().flatten());
        }
    }
    let piece = PolyDataPiece {
        points: places.into(),
        lines: Some(VertexNumbers::Legacy {
            num_cells: curves_in(&lines),
            vertices: lines,
        }),
        data: Attributes {
            point: vec![Attribute::scalars("manifold", 1).with_data(numbers)],
            cell: Vec::new(),
        },
        ..PolyDataPiece::default()
    };
    write("self-motion manifolds, degrees", piece, path)
}

/// Number of cells in VTK's list of counts and indices.
fn curves_in(lines: &[u32]) -> u32 {
    let (mut at, mut count) = (0, 0);
    while let Some(length) = lines.get(at) {
        at += *length as usize + 1;
        count += 1;
    }
    count
}

fn scalars(name: &str, values: Vec<f32>) -> Attribute {
    Attribute::scalars(name, 1).with_data(values)
}

fn write(title: &str, piece: PolyDataPiece, path: &Path) -> Result<(), ReportError> {
    let file = Vtk {
        version: Version::new_legacy(3, 0),
        title: title.into(),
        byte_order: ByteOrder::BigEndian,
        data: DataSet::inline(piece),
        file_path: None,
    };
    let mut text = String::new();
    file.write_legacy_ascii(&mut text)?;
    write_text(path, &text)
}
