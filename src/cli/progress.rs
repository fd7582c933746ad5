//! Shows how far a run is: a bar on a terminal, plain lines otherwise.

use super::output;
use crate::study::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Shortest time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(2);

/// The progress display that suits stderr.
pub(super) fn display(quiet: bool) -> Arc<dyn Progress> {
    if quiet {
        Arc::new(Silent)
    } else if io::stderr().is_terminal() {
        Arc::new(Bar::new())
    } else {
        Arc::new(Lines::default())
    }
}

struct Silent;

impl Progress for Silent {
    fn update(&self, _: u64, _: u64, _: f64, _: &str) {}
}

struct Bar {
    bar: ProgressBar,
}

impl Bar {
    fn new() -> Bar {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style = "{elapsed_precise} [{bar:30}] {pos}/{len} {wide_msg}";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style.progress_chars("=> "));
        }
        Bar { bar }
    }
}

impl Progress for Bar {
    fn update(&self, done: u64, total: u64, best: f64, message: &str) {
        self.bar.set_length(total);
        self.bar.set_position(done);
        self.bar.set_message(describe(best, message));
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[derive(Default)]
struct Lines {
    last: Mutex<Option<Instant>>,
}

impl Lines {
    /// Whether enough time has passed since the last line; if so, this moment becomes the last.
    fn due(&self) -> bool {
        let Ok(mut last) = self.last.lock() else {
            return false;
        };
        let due = last.is_none_or(|last| last.elapsed() >= LINE_INTERVAL);
        if due {
            *last = Some(Instant::now());
        }
        due
    }
}

impl Progress for Lines {
    fn update(&self, done: u64, total: u64, best: f64, message: &str) {
        if self.due() {
            output::message(&format!("{done}/{total} {}", describe(best, message)));
        }
    }
}

fn describe(best: f64, message: &str) -> String {
    if best.is_finite() {
        format!("best {best:.6}  {message}")
    } else {
        message.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_keep_their_distance() {
        let lines = Lines::default();
        assert!(lines.due());
        assert!(!lines.due());
    }

    #[test]
    fn a_missing_best_value_is_left_out() {
        assert_eq!(describe(f64::NEG_INFINITY, "sampling"), "sampling");
        assert_eq!(describe(3.5, "sweep 2"), "best 3.500000  sweep 2");
    }
}
