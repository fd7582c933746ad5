//! What the tail of a planar chain reaches inside its limits, as arcs on every circle |z| = r.
//!
//! With T_n = {l_n} and T_k = { l_k + e^{iθ}·w : θ ∈ A_{k+1}, w ∈ T_{k+1} }, the pre-failure
//! workspace in polar form is W₀(r) = A₁ ⊕ E(r) with E(r) = { arg z : z ∈ T₁, |z| = r }.
//!
//! The boundary of T_k consists of circles: the boundary circles of T_{k+1} turned to either limit
//! of joint k+1, and circles around joint k+1 whose radius is one where T_{k+1} appears, ends or
//! jumps. Where two circles meet, or one touches |z| = r, the arcs of E change; between
//! those *critical radii* each arc runs from one fixed circle to another. A [`Region`] stores the
//! arcs of every such panel of radii by the circles that bound them, so that any E(r) costs
//! two arc tangents an arc, and areas integrate in closed form.

use super::circle::{Circle, Side};
use super::sweep::{CellSweep, Edge, EdgeArc};
use crate::angle::{AngleSet, Arc};
use crate::workspace::JointLimit;
use nalgebra::Complex;
use std::ops::Range;

/// Circles closer than this share of the reach are one: limits that are mirror images give pairs
/// of circles that differ by round-off only.
const SAME_CIRCLE: f64 = 1e-12;

/// Panels of radii thinner than this share of the reach are dropped: at most this share of the
/// workspace's area goes unseen per panel.
const THIN_PANEL: f64 = 1e-12;

/// Arc ends that differ by more than this (radians) at a critical radius mark a jump of the set.
/// Arcs meet their neighbours' ends to about √ε where circles touch |z| = r.
const JUMP: f64 = 1e-6;

/// Radii between which E(r) keeps its structure.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub inner: f64,
    pub outer: f64,
    /// Whether E(r) is the full circle; then there are no arcs.
    pub full: bool,
    arcs: Range<u32>,
}

impl Panel {
    /// A panel on which the set is the full circle.
    pub fn full(inner: f64, outer: f64) -> Panel {
        Panel {
            inner,
            outer,
            full: true,
            arcs: 0..0,
        }
    }
}

/// E(r) for all radii of a range. Reusable: rebuilding keeps the buffers.
#[derive(Clone, Debug, Default)]
pub(super) struct Region {
    circles: Vec<Circle>,
    arcs: Vec<EdgeArc>,
    panels: Vec<Panel>,
    /// Radii at which the set appears, ends or jumps.
    events: Vec<f64>,
    reach: f64,
    critical: Vec<f64>,
    sweep: CellSweep,
}

/// T_{k+1} and the joint and link that carry it.
#[derive(Clone, Copy)]
pub(super) struct Carrier<'a> {
    pub length: f64,
    pub limit: JointLimit,
    pub tail: &'a Region,
}

impl Region {
    pub fn panels(&self) -> &[Panel] {
        &self.panels
    }

    pub fn arcs_of(&self, panel: &Panel) -> &[EdgeArc] {
        &self.arcs[panel.arcs.start as usize..panel.arcs.end as usize]
    }

    /// The circles that the edges of arcs name.
    pub fn circles(&self) -> &[Circle] {
        &self.circles
    }

    /// Radii at which E(r) appears, ends or jumps.
    pub fn events(&self) -> &[f64] {
        &self.events
    }

    /// The panel that holds radius `r`, if E(r) is not empty there.
    fn panel_at(&self, r: f64) -> Option<&Panel> {
        let k = self.panels.partition_point(|panel| panel.outer < r);
        self.panels.get(k).filter(|panel| panel.inner <= r)
    }

    /// E(r) from the panel that holds `r`.
    pub fn set_at(&self, r: f64) -> AngleSet {
        match self.panel_at(r) {
            None => AngleSet::empty(),
            Some(panel) if panel.full => AngleSet::full(),
            Some(panel) => {
                let arcs = self.arcs_of(panel).iter();
                AngleSet::from_arcs(arcs.map(|arc| {
                    let (start, width) = arc.at(&self.circles, r);
                    Arc::new(start, width)
                }))
            }
        }
    }

    fn clear(&mut self) {
        self.circles.clear();
        self.arcs.clear();
        self.panels.clear();
        self.events.clear();
        self.critical.clear();
    }

    /// The region of a chain with one moving joint behind joint 1: the arc l + e^{iθ}·l′, θ ∈ A.
    /// Every E(r) holds at most two single angles.
    pub fn rebuild_arc(&mut self, length: f64, limit: JointLimit, last: f64) {
        self.clear();
        self.reach = length + last;
        self.circles
            .push(Circle::new(Complex::new(length, 0.0), last));
        let at = |q: f64| {
            (length * length + last * last + 2.0 * length * last * q.cos())
                .max(0.0)
                .sqrt()
        };
        self.critical.extend([(length - last).abs(), length + last]);
        if !limit.is_full() {
            self.critical.extend([at(limit.lower), at(limit.upper)]);
        }
        sort_distinct(&mut self.critical, THIN_PANEL * self.reach);
        let allowed = limit.arc();
        for k in 1..self.critical.len() {
            let (inner, outer) = (self.critical[k - 1], self.critical[k]);
            let r = 0.5 * (inner + outer);
            let cosine = (r * r - length * length - last * last) / (2.0 * length * last);
            let bend = cosine.clamp(-1.0, 1.0).acos();
            let first = self.arcs.len() as u32;
            for (side, angle) in [(Side::Left, bend), (Side::Right, -bend)] {
                if allowed.contains(angle) {
                    let edge = Edge { circle: 0, side };
                    self.arcs.push(EdgeArc {
                        start: edge,
                        end: edge,
                        turns: 0.0,
                    });
                }
            }
            let arcs = first..self.arcs.len() as u32;
            self.push_panel(inner, outer, false, arcs);
        }
        // The swept arc ends at each of these radii, or turns back.
        self.events.extend_from_slice(&self.critical);
    }

    /// The region of the carrier's link and joint with its tail, for radii in `range`.
    pub fn rebuild(&mut self, carrier: Carrier<'_>, range: [f64; 2]) {
        self.clear();
        self.reach = carrier.length + carrier.tail.reach;
        self.collect_circles(carrier);
        self.collect_critical_radii(range);
        for k in 1..self.critical.len() {
            let (inner, outer) = (self.critical[k - 1], self.critical[k]);
            self.classify_panel(carrier, inner, outer);
        }
        self.collect_events();
    }

    fn collect_circles(&mut self, carrier: Carrier<'_>) {
        let tolerance = SAME_CIRCLE * self.reach;
        let shift = Complex::new(carrier.length, 0.0);
        if !carrier.limit.is_full() {
            for angle in [carrier.limit.lower, carrier.limit.upper] {
                let turn = Complex::from_polar(1.0, angle);
                for circle in carrier.tail.bounding_circles() {
                    let turned = Circle::new(shift + turn * circle.centre, circle.radius);
                    self.add_circle(turned, tolerance);
                }
            }
        }
        for &radius in &carrier.tail.events {
            self.add_circle(Circle::new(shift, radius), tolerance);
        }
    }

    /// The circles that bound some arc.
    fn bounding_circles(&self) -> impl Iterator<Item = &Circle> {
        let bounds = |k: u32| {
            let mut arcs = self.arcs.iter();
            arcs.any(|arc| arc.start.circle == k || arc.end.circle == k)
        };
        (0u32..)
            .zip(&self.circles)
            .filter(move |(k, _)| bounds(*k))
            .map(|(_, circle)| circle)
    }

    fn add_circle(&mut self, circle: Circle, tolerance: f64) {
        let known = |c: &Circle| c.coincides(&circle, tolerance);
        if circle.radius > tolerance && !self.circles.iter().any(known) {
            self.circles.push(circle);
        }
    }

    fn collect_critical_radii(&mut self, range: [f64; 2]) {
        let Region {
            circles, critical, ..
        } = self;
        let mut add = |r: f64| {
            if range[0] < r && r < range[1] {
                critical.push(r);
            }
        };
        for (k, circle) in circles.iter().enumerate() {
            add(circle.nearest());
            add(circle.farthest());
            for other in &circles[..k] {
                if let Some(radii) = circle.crossing_radii(other) {
                    radii.into_iter().for_each(&mut add);
                }
            }
        }
        critical.extend([range[0], range[1].min(self.reach)]);
        sort_distinct(critical, THIN_PANEL * self.reach);
    }

    /// Finds the arcs of E in the middle of a panel and stores them by their edges.
    fn classify_panel(&mut self, carrier: Carrier<'_>, inner: f64, outer: f64) {
        let r = 0.5 * (inner + outer);
        self.sweep.clear();
        for (circle, k) in self.circles.iter().zip(0u32..) {
            if circle.crosses(r) {
                for side in [Side::Left, Side::Right] {
                    let edge = Edge { circle: k, side };
                    self.sweep.mark(circle.polar_angle(r, side), edge);
                }
            }
        }
        let reaches = |angle| carrier.reaches(Complex::from_polar(r, angle));
        self.sweep.classify(reaches);
        let first = self.arcs.len() as u32;
        let full = self.sweep.is_full();
        if !full {
            self.sweep.append_arcs(&self.circles, r, &mut self.arcs);
        }
        let arcs = first..self.arcs.len() as u32;
        self.push_panel(inner, outer, full, arcs);
    }

    /// Appends a panel, or extends the last one if it has the same arcs.
    fn push_panel(&mut self, inner: f64, outer: f64, full: bool, arcs: Range<u32>) {
        if !full && arcs.is_empty() {
            return;
        }
        if let Some(last) = self.panels.last_mut()
            && last.outer == inner
            && last.full == full
        {
            let of = |r: &Range<u32>| r.start as usize..r.end as usize;
            if self.arcs[of(&last.arcs)] == self.arcs[of(&arcs)] {
                last.outer = outer;
                self.arcs.truncate(arcs.start as usize);
                return;
            }
        }
        self.panels.push(Panel {
            inner,
            outer,
            full,
            arcs,
        });
    }

    /// Notes the radii where the set appears, ends or jumps.
    fn collect_events(&mut self) {
        let mut events = std::mem::take(&mut self.events);
        for (k, panel) in self.panels.iter().enumerate() {
            let before = k.checked_sub(1).map(|j| &self.panels[j]);
            match before {
                Some(before) if before.outer == panel.inner => {
                    if !self.continuous(before, panel) {
                        events.push(panel.inner);
                    }
                }
                Some(before) => events.extend([before.outer, panel.inner]),
                None => events.push(panel.inner),
            }
        }
        events.extend(self.panels.last().map(|panel| panel.outer));
        self.events = events;
    }

    /// Whether the arcs of two adjoining panels agree at the radius between them.
    fn continuous(&self, before: &Panel, after: &Panel) -> bool {
        let (a, b) = (self.arcs_of(before), self.arcs_of(after));
        if before.full != after.full || a.len() != b.len() {
            return false;
        }
        let r = after.inner;
        let near = |x: f64, y: f64| crate::angle::wrap(x - y).abs() <= JUMP;
        a.iter().all(|p| {
            let (start, width) = p.at(&self.circles, r);
            b.iter().any(|q| {
                let (other, other_width) = q.at(&self.circles, r);
                near(start, other) && (width - other_width).abs() <= JUMP
            })
        })
    }
}

impl Carrier<'_> {
    /// Whether `z` ∈ T_k, i.e. arg(z − l_k) ∈ A_{k+1} ⊕ E_{k+1}(|z − l_k|).
    fn reaches(&self, z: Complex<f64>) -> bool {
        let u = z - self.length;
        let r = u.norm();
        let Some(panel) = self.tail.panel_at(r) else {
            return false;
        };
        if panel.full || self.limit.is_full() {
            return true;
        }
        let angle = u.arg();
        let joint_width = self.limit.upper - self.limit.lower;
        self.tail.arcs_of(panel).iter().any(|arc| {
            let (start, width) = arc.at(&self.tail.circles, r);
            crate::angle::turn(start + self.limit.lower, angle) <= width + joint_width
        })
    }

    /// E at one radius by direct classification, without the panels of radii: an independent
    /// check of [`Region::set_at`].
    pub fn set_at(&self, scratch: &mut Region, r: f64) -> AngleSet {
        scratch.clear();
        scratch.reach = self.length + self.tail.reach;
        scratch.collect_circles(*self);
        scratch.classify_panel(*self, r, r);
        scratch.set_at(r)
    }
}

/// Sorts numbers and drops those closer than `tolerance` to their predecessor.
pub(super) fn sort_distinct(values: &mut Vec<f64>, tolerance: f64) {
    values.sort_unstable_by(f64::total_cmp);
    values.dedup_by(|next, kept| *next - *kept <= tolerance);
}
