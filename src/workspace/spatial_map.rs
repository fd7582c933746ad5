//! Where the workspace of a spatial task lies: a polar grid about joint 1's axis.

use std::f64::consts::{PI, TAU};

/// Where the fault-tolerant workspace of a spatial task lies: shares of orientations on a polar
/// grid about joint 1's axis, which is the z axis. The unrestricted workspace does not change as
/// the arm turns about that axis, so it has no azimuth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpatialShareMap {
    /// Edges of the cells in distance from joint 1's axis, ascending, metres.
    pub radius_edges: Vec<f64>,
    /// Edges of the cells along joint 1's axis, ascending, metres.
    pub height_edges: Vec<f64>,
    /// Number of cells around the circle; cell k covers azimuths
    /// −π + 2πk/`azimuths` … −π + 2π(k+1)/`azimuths`.
    pub azimuths: usize,
    /// Share in [0, 1] of the orientations that are fault tolerant, at index
    /// (ir · heights + iz) · `azimuths` + k. For position tasks the share of the azimuth cell.
    pub share: Vec<f32>,
    /// Share in [0, 1] of the orientations in reach with all joints free, at ir · heights + iz.
    pub unrestricted: Vec<f32>,
    /// Whether shares are of orientations (pose task) or of the cell (position task).
    pub orientations: bool,
}

impl SpatialShareMap {
    /// Number of cells in radius.
    pub fn radii(&self) -> usize {
        self.radius_edges.len().saturating_sub(1)
    }

    /// Number of cells in height.
    pub fn heights(&self) -> usize {
        self.height_edges.len().saturating_sub(1)
    }

    /// Radius of the middle of a cell, metres.
    ///
    /// # Panics
    /// If `ir` is not below [`Self::radii`].
    pub fn radius(&self, ir: usize) -> f64 {
        0.5 * (self.radius_edges[ir] + self.radius_edges[ir + 1])
    }

    /// Height of the middle of a cell, metres.
    ///
    /// # Panics
    /// If `iz` is not below [`Self::heights`].
    pub fn height(&self, iz: usize) -> f64 {
        0.5 * (self.height_edges[iz] + self.height_edges[iz + 1])
    }

    /// Azimuth of the middle of a cell, radians.
    pub fn azimuth(&self, k: usize) -> f64 {
        -PI + TAU * (k as f64 + 0.5) / self.azimuths.max(1) as f64
    }

    /// Fault-tolerant share of a cell; 0 where the map holds no number.
    pub fn share_at(&self, ir: usize, iz: usize, k: usize) -> f64 {
        let index = (ir * self.heights() + iz) * self.azimuths + k;
        let is_cell = iz < self.heights() && k < self.azimuths;
        number(is_cell.then(|| self.share.get(index)).flatten())
    }

    /// Reachable share of a cell, whatever its azimuth; 0 where the map holds no number.
    pub fn unrestricted_at(&self, ir: usize, iz: usize) -> f64 {
        let is_cell = iz < self.heights();
        let value = is_cell.then(|| self.unrestricted.get(ir * self.heights() + iz));
        number(value.flatten())
    }

    /// Mean over azimuth of the fault-tolerant share.
    pub fn mean(&self, ir: usize, iz: usize) -> f64 {
        let sum: f64 = (0..self.azimuths).map(|k| self.share_at(ir, iz, k)).sum();
        sum / self.azimuths.max(1) as f64
    }

    /// Indices (ir, iz, k) of the cell at (x, y, z) metres; none outside the grid.
    pub fn cell(&self, [x, y, z]: [f64; 3]) -> Option<[usize; 3]> {
        let ir = interval(&self.radius_edges, x.hypot(y))?;
        let iz = interval(&self.height_edges, z)?;
        let last = self.azimuths.checked_sub(1)?;
        let around = (y.atan2(x) + PI) / TAU * self.azimuths as f64;
        Some([ir, iz, (around as usize).min(last)])
    }

    /// Fault-tolerant share at (x, y, z) metres; none outside the grid.
    pub fn sample(&self, point: [f64; 3]) -> Option<f64> {
        let [ir, iz, k] = self.cell(point)?;
        Some(self.share_at(ir, iz, k))
    }

    /// Index of the height at which the fault-tolerant share, integrated over the horizontal
    /// plane, is largest; the lowest of equals, and none if the map is empty.
    pub fn fullest_height(&self) -> Option<usize> {
        let area = |ir: usize| self.radius_edges[ir + 1].powi(2) - self.radius_edges[ir].powi(2);
        let integral = |iz: usize| -> f64 {
            (0..self.radii())
                .map(|ir| area(ir) * self.mean(ir, iz))
                .sum()
        };
        let mut best = None;
        for (iz, value) in (0..self.heights()).map(|iz| (iz, integral(iz))) {
            if value > best.map_or(0.0, |(_, most)| most) {
                best = Some((iz, value));
            }
        }
        best.map(|(iz, _)| iz)
    }

    /// Whether edges ascend and are finite, radii are not negative, all cells have their numbers
    /// and these lie in [0, 1]; otherwise what is wrong.
    pub fn check(&self) -> Result<(), String> {
        for (name, edges) in [
            ("radius", &self.radius_edges),
            ("height", &self.height_edges),
        ] {
            if edges.len() < 2 {
                return Err(format!(
                    "{} {name} edges where at least 2 are needed",
                    edges.len()
                ));
            }
            if !edges.iter().all(|edge| edge.is_finite()) {
                return Err(format!("a {name} edge is not finite"));
            }
            if !edges.windows(2).all(|pair| pair[0] < pair[1]) {
                return Err(format!("the {name} edges do not ascend"));
            }
        }
        if self.radius_edges[0] < 0.0 {
            return Err("a radius is negative".into());
        }
        let cells = self.radii() * self.heights();
        for (name, values, count) in [
            ("shares", &self.share, cells * self.azimuths),
            ("unrestricted shares", &self.unrestricted, cells),
        ] {
            if values.len() != count || count == 0 {
                return Err(format!("{} {name} for {count} cells", values.len()));
            }
            if !values.iter().all(|value| (0.0..=1.0).contains(value)) {
                return Err(format!("one of the {name} is not in [0, 1]"));
            }
        }
        Ok(())
    }
}

/// A finite number, else 0.
fn number(value: Option<&f32>) -> f64 {
    value.map_or(0.0, |v| if v.is_finite() { f64::from(*v) } else { 0.0 })
}

/// Which of the half-open intervals between ascending `edges` holds `value`. Fast where all are of
/// one width.
pub(crate) fn interval(edges: &[f64], value: f64) -> Option<usize> {
    let ([first, ..], [.., last]) = (edges, edges) else {
        return None;
    };
    let guess = ((value - first) / (last - first) * (edges.len() - 1) as f64) as usize;
    let holds = |k: usize| Some(*edges.get(k)? <= value && value < *edges.get(k + 1)?);
    if holds(guess) == Some(true) {
        return Some(guess);
    }
    let index = edges
        .partition_point(|edge| *edge <= value)
        .checked_sub(1)?;
    (index + 1 < edges.len()).then_some(index)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> SpatialShareMap {
        SpatialShareMap {
            radius_edges: vec![0.0, 1.0, 2.0],
            height_edges: vec![-1.0, 0.0, 1.0],
            azimuths: 4,
            share: (0..16).map(|k| k as f32 / 16.0).collect(),
            unrestricted: vec![0.25, 0.5, 0.75, 1.0],
            orientations: true,
        }
    }

    #[test]
    fn cells_are_found_by_radius_height_and_azimuth() {
        let map = map();
        assert_eq!(map.check(), Ok(()));
        assert_eq!(map.cell([0.5, 0.1, -0.5]), Some([0, 0, 2]));
        assert_eq!(map.cell([-1.5, 0.0, 0.5]), Some([1, 1, 3]));
        assert_eq!(map.cell([-1.5, -0.1, 0.0]), Some([1, 1, 0]));
        assert_eq!(map.sample([-1.5, -0.1, 0.0]), Some(12.0 / 16.0));
        assert_eq!(map.sample([2.0, 0.0, 0.0]), None);
        assert_eq!(map.sample([0.0, 0.0, f64::NAN]), None);
        assert_eq!(map.mean(1, 1), 13.5 / 16.0);
        assert_eq!(map.unrestricted_at(1, 0), 0.75);
        assert_eq!([map.radius(1), map.height(0)], [1.5, -0.5]);
        let middle = [map.azimuth(2).cos(), map.azimuth(2).sin(), 0.5];
        assert_eq!(map.cell(middle), Some([1, 1, 2]));
    }

    #[test]
    fn indices_beyond_the_grid_have_no_share() {
        let map = map();
        assert_eq!(map.share_at(0, 2, 0) + map.share_at(2, 0, 0), 0.0);
        assert_eq!(map.share_at(0, 0, 4) + map.unrestricted_at(0, 2), 0.0);
        assert_eq!(SpatialShareMap::default().sample([0.0; 3]), None);
    }

    #[test]
    fn intervals_may_differ_in_width() {
        let edges = [0.0, 0.1, 0.2, 5.0];
        let found = [-0.1, 0.0, 0.15, 0.2, 4.9, 5.0].map(|value| interval(&edges, value));
        assert_eq!(found, [None, Some(0), Some(1), Some(2), Some(2), None]);
        assert_eq!([interval(&[], 0.0), interval(&[1.0], 1.0)], [None, None]);
    }

    #[test]
    fn the_fullest_height_weighs_by_area() {
        let mut map = map();
        map.share = vec![0.0; 16];
        assert_eq!(map.fullest_height(), None);
        // An inner cell at height 0, an outer one of half the share but thrice the area at 1.
        map.share[..4].fill(0.5);
        map.share[12..].fill(0.25);
        assert_eq!(map.fullest_height(), Some(1));
        map.share[12..].fill(0.16);
        assert_eq!(map.fullest_height(), Some(0));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let refused = |change: fn(&mut SpatialShareMap)| {
            let mut map = map();
            change(&mut map);
            map.check().unwrap_err()
        };
        assert!(refused(|m| m.radius_edges[2] = 0.5).contains("radius edges do not ascend"));
        assert!(refused(|m| m.height_edges[0] = f64::NAN).contains("height edge is not finite"));
        assert!(refused(|m| m.height_edges.truncate(1)).contains("1 height edges"));
        assert!(refused(|m| m.radius_edges[0] = -1.0).contains("negative"));
        assert!(refused(|m| m.azimuths = 3).contains("16 shares for 12 cells"));
        assert!(refused(|m| m.unrestricted[0] = 1.5).contains("not in [0, 1]"));
        assert!(refused(|m| m.share[0] = f32::NAN).contains("not in [0, 1]"));
        assert!(refused(|m| *m = SpatialShareMap::default()).contains("0 radius edges"));
    }
}
