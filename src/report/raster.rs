//! Antialiased filling of polygons for the bitmap canvas.
//!
//! plotters' own rasteriser works on whole pixels, leaves holes where a thick line overlaps
//! itself, and blends a shape with itself where its parts meet. Here a shape is any number of
//! contours filled once by the non-zero rule, with exact coverage along a scan line and
//! [`SUBLINES`] lines a pixel.

/// Scan lines per row of pixels.
const SUBLINES: usize = 4;

/// A point in pixels, y downwards.
pub(super) type Point = [f64; 2];

/// Calls `paint(x, y, length, coverage)` for every run of pixels that `contours` cover.
///
/// Coverage lies in (0, 1]; runs stay inside `size`.
pub(super) fn fill(
    contours: &[Vec<Point>],
    size: (u32, u32),
    mut paint: impl FnMut(i32, i32, i32, f64),
) {
    let mut edges = edges(contours);
    edges.sort_by(|a, b| a.top.total_cmp(&b.top));
    let bottom = edges.iter().map(|e| e.bottom).fold(0.0, f64::max);
    let first = edges.first().map_or(0.0, |e| e.top).max(0.0) as u32;
    let last = (bottom.ceil() as u32).min(size.1);
    let (mut next, mut active, mut row) = (0, Vec::new(), Row::new(size.0));
    for y in first..last {
        for sub in 0..SUBLINES {
            let line = f64::from(y) + (sub as f64 + 0.5) / SUBLINES as f64;
            while next < edges.len() && edges[next].top <= line {
                active.push(edges[next]);
                next += 1;
            }
            active.retain(|e| e.bottom > line);
            cover(&active, line, &mut row);
        }
        row.flush(y as i32, &mut paint);
    }
}

#[derive(Clone, Copy)]
struct Edge {
    top: f64,
    bottom: f64,
    /// x where the edge starts at `top`.
    x: f64,
    slope: f64,
    winding: i32,
}

fn edges(contours: &[Vec<Point>]) -> Vec<Edge> {
    let finite = |p: &Point| p[0].is_finite() && p[1].is_finite();
    let mut edges = Vec::new();
    for contour in contours {
        let points: Vec<Point> = contour.iter().copied().filter(finite).collect();
        for (k, &p) in points.iter().enumerate() {
            let q = points[(k + 1) % points.len()];
            if p[1] == q[1] {
                continue;
            }
            let (a, b, winding) = if p[1] < q[1] { (p, q, 1) } else { (q, p, -1) };
            edges.push(Edge {
                top: a[1],
                bottom: b[1],
                x: a[0],
                slope: (b[0] - a[0]) / (b[1] - a[1]),
                winding,
            });
        }
    }
    edges
}

/// Adds the spans of one scan line to the row.
fn cover(active: &[Edge], line: f64, row: &mut Row) {
    let mut crossings: Vec<(f64, i32)> = active
        .iter()
        .map(|e| (e.x + (line - e.top) * e.slope, e.winding))
        .collect();
    crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut winding, mut start) = (0, 0.0);
    for (x, step) in crossings {
        if winding == 0 {
            start = x;
        }
        winding += step;
        if winding == 0 {
            row.add(start, x);
        }
    }
}

/// Coverage of one row of pixels.
struct Row {
    coverage: Vec<f32>,
    /// Touched pixels, empty when `.0 >= .1`.
    touched: (usize, usize),
}

impl Row {
    fn new(width: u32) -> Row {
        Row {
            coverage: vec![0.0; width as usize],
            touched: (width as usize, 0),
        }
    }

    fn add(&mut self, from: f64, to: f64) {
        let width = self.coverage.len() as f64;
        let (from, to) = (from.clamp(0.0, width), to.clamp(0.0, width));
        if to <= from {
            return;
        }
        let (first, last) = (from as usize, (to.ceil() as usize).min(self.coverage.len()));
        self.touched = (self.touched.0.min(first), self.touched.1.max(last));
        for x in first..last {
            let inside = to.min(x as f64 + 1.0) - from.max(x as f64);
            self.coverage[x] += (inside / SUBLINES as f64) as f32;
        }
    }

    /// Paints runs of equal coverage and clears the row.
    fn flush(&mut self, y: i32, paint: &mut impl FnMut(i32, i32, i32, f64)) {
        let (mut x, end) = self.touched;
        while x < end {
            let value = self.coverage[x];
            let mut stop = x + 1;
            while stop < end && self.coverage[stop] == value {
                stop += 1;
            }
            if value > 0.0 {
                let value = if value > 0.999 { 1.0 } else { f64::from(value) };
                paint(x as i32, y, (stop - x) as i32, value);
            }
            x = stop;
        }
        if self.touched.0 < end {
            self.coverage[self.touched.0..end].fill(0.0);
        }
        self.touched = (self.coverage.len(), 0);
    }
}

/// The contours of a line of the given width through `path`, with round joins and ends.
pub(super) fn stroke(path: &[Point], width: f64) -> Vec<Vec<Point>> {
    let radius = 0.5 * width;
    let mut contours = Vec::with_capacity(2 * path.len());
    for pair in path.windows(2) {
        let (p, q) = (pair[0], pair[1]);
        let length = (q[0] - p[0]).hypot(q[1] - p[1]);
        if length > 0.0 {
            let n = [
                -(q[1] - p[1]) / length * radius,
                (q[0] - p[0]) / length * radius,
            ];
            contours.push(vec![
                [p[0] + n[0], p[1] + n[1]],
                [q[0] + n[0], q[1] + n[1]],
                [q[0] - n[0], q[1] - n[1]],
                [p[0] - n[0], p[1] - n[1]],
            ]);
        }
    }
    contours.extend(path.iter().map(|&p| disc(p, radius)));
    contours
}

/// A disc with the orientation of the segments in [`stroke`]; opposite ones would cancel.
pub(super) fn disc(centre: Point, radius: f64) -> Vec<Point> {
    let corners = (radius * 4.0).clamp(12.0, 240.0) as usize;
    let corner = |k: usize| {
        let angle = -(k as f64) * std::f64::consts::TAU / corners as f64;
        [
            centre[0] + radius * angle.cos(),
            centre[1] + radius * angle.sin(),
        ]
    };
    (0..corners).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(contours: &[Vec<Point>]) -> f64 {
        let mut sum = 0.0;
        fill(contours, (100, 100), |_, _, length, coverage| {
            sum += f64::from(length) * coverage;
        });
        sum
    }

    #[test]
    fn coverage_sums_to_the_area() {
        let triangle = vec![vec![[10.0, 10.0], [70.5, 20.25], [30.0, 90.0]]];
        let exact = 0.5 * ((60.5 * 80.0) - (10.25 * 20.0));
        assert!((area(&triangle) - exact).abs() < 2.0);
        assert!((area(&[disc([50.0, 50.0], 30.0)]) - 2827.0).abs() < 10.0);
    }

    #[test]
    fn a_line_over_itself_has_no_holes() {
        let there_and_back = [[20.0, 50.0], [80.0, 50.0], [20.0, 50.0]];
        let ends = std::f64::consts::PI * 25.0;
        assert!((area(&stroke(&there_and_back, 10.0)) - 600.0 - ends).abs() < 4.0);
    }

    #[test]
    fn odd_input_paints_nothing_outside() {
        let wild = vec![
            vec![
                [f64::NAN, 1.0],
                [-1e9, 5.0],
                [1e9, 7.0],
                [3.0, f64::INFINITY],
            ],
            vec![],
            vec![[1.0, 1.0]],
        ];
        fill(&wild, (20, 20), |x, y, length, coverage| {
            assert!(x >= 0 && y >= 0 && x + length <= 20 && y < 20);
            assert!(coverage > 0.0 && coverage <= 1.0);
        });
    }
}
