//! How a population's scores rose from stage to stage of a search, and what was left of them on
//! samples that the search had not seen.

use super::canvas::{Canvas, Point, Size};
use super::figure::Figure;
use super::label::{LEGEND_ROW, Label, Swatch, legend, rectangle};
use super::number::{with_error, with_unit};
use super::panel::{BOTTOM, Panel, left, range};
use super::style::{BLUE, COLUMN, GREEN, GREY, MARGIN, ORANGE, SKY, SMALL, TITLE, translucent};
use super::table::{Table, cell};
use super::ticks;
use plotters::style::text_anchor::HPos;

/// The course of a search in stages.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchHistoryFigure {
    /// What is maximised, as in "S_F / S_0max".
    pub score_label: String,
    /// Unit of all scores, as in "%"; may be empty.
    pub unit: String,
    /// What the horizontal axis counts, as in "evaluations" or "generations".
    pub axis_label: String,
    /// The stages in order.
    pub stages: Vec<HistoryStage>,
    /// The winner's score on samples that neither search nor selection used, with its standard
    /// error.
    pub reported: Option<[f64; 2]>,
    /// Title above the plot; none if empty.
    pub title: String,
}

/// One stage of a search.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryStage {
    /// Its name, as in "screening".
    pub name: String,
    /// Its generations in order.
    pub generations: Vec<HistoryGeneration>,
}

/// The scores of one generation, as the search saw them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HistoryGeneration {
    /// Where it stands on the horizontal axis: evaluations or generations so far, over all stages.
    pub at: f64,
    /// The best score of the generation.
    pub best: f64,
    /// The median of its scores.
    pub median: f64,
    /// Lower and upper quartile of its scores.
    pub quartiles: [f64; 2],
}

/// Height of the plot without legend and labels, points.
const HEIGHT: f64 = 130.0;

impl SearchHistoryFigure {
    fn generations(&self) -> impl Iterator<Item = &HistoryGeneration> + Clone {
        self.stages.iter().flat_map(|stage| &stage.generations)
    }

    fn title_height(&self) -> f64 {
        if self.title.is_empty() { 0.0 } else { 13.0 }
    }

    /// Names of stages that have no room above their part of the plot stand in a row of their own.
    fn needs_key(&self, panel: &Panel) -> bool {
        let too_wide = |stage: &HistoryStage, [from, to]: [f64; 2]| {
            Label::new(&stage.name, SMALL).width() > to - from - 3.0
        };
        let mut stages = self.spans(panel).into_iter();
        stages.any(|(stage, span)| too_wide(stage, span))
    }

    fn head(&self, has_key: bool) -> f64 {
        let key = if has_key { LEGEND_ROW } else { 0.0 };
        MARGIN + self.title_height() + 2.0 * LEGEND_ROW + key + 12.0
    }

    fn panel(&self) -> Panel {
        let reported = self.reported.into_iter().flat_map(|[value, error]| {
            let error = if error.is_finite() { error } else { 0.0 };
            [value - error, value + error]
        });
        let scores = self
            .generations()
            .flat_map(|g| [g.best, g.median, g.quartiles[0], g.quartiles[1]]);
        let scores = scores.chain(reported);
        let [low, high] = range(scores.clone(), 0.07);
        let is_negative = scores.into_iter().any(|score| score < 0.0);
        let y = [if is_negative { low } else { low.max(0.0) }, high];
        let left = left(&ticks::round(y[0], y[1], 5));
        let mut panel = Panel {
            left,
            top: 0.0,
            width: COLUMN - left - 12.0,
            height: HEIGHT,
            x: range(self.generations().map(|g| g.at).chain([0.0]), 0.0),
            y,
        };
        panel.top = self.head(self.needs_key(&panel));
        panel
    }

    /// Stages with anything in them and where they begin and end on the sheet.
    fn spans(&self, panel: &Panel) -> Vec<(&HistoryStage, [f64; 2])> {
        let mut spans = Vec::new();
        let mut from = panel.left;
        for stage in &self.stages {
            let places = stage
                .generations
                .iter()
                .map(|g| panel.at(g.at, panel.y[0])[0]);
            let end = places
                .filter(|x| x.is_finite())
                .fold(f64::NEG_INFINITY, f64::max);
            if end.is_finite() {
                let to = end.clamp(from, panel.left + panel.width);
                spans.push((stage, [from, to]));
                from = to;
            }
        }
        spans
    }

    /// Lines between stages, with the stages' names or, where these are too long, letters above.
    fn draw_stages(&self, canvas: &mut Canvas, panel: &Panel) {
        let spans = self.spans(panel);
        let needs_key = self.needs_key(panel);
        let bottom = panel.top + panel.height;
        // Neighbours of one name share an entry: its first and last letter.
        let mut key: Vec<([String; 2], &str)> = Vec::new();
        for (number, (stage, [from, to])) in spans.iter().enumerate() {
            if number > 0 {
                canvas.stroke(&[[*from, panel.top - 2.0], [*from, bottom]], 0.5, GREY);
            }
            let letter = char::from(b'A' + (number % 26) as u8).to_string();
            let text = if needs_key { &letter } else { &stage.name };
            let label = Label::new(text, SMALL).align(HPos::Center).bold();
            let label = if needs_key {
                label
            } else {
                Label {
                    bold: false,
                    ..label
                }
            };
            label.draw(canvas, [0.5 * (from + to), panel.top - 3.5]);
            match key.last_mut() {
                Some((letters, name)) if *name == stage.name => letters[1] = letter,
                _ => key.push(([letter.clone(), letter], &stage.name)),
            }
        }
        if needs_key {
            let at = [panel.left, panel.top - 13.5];
            let entry = |([first, last], name): &([String; 2], &str)| match first == last {
                true => format!("{first} {name}"),
                false => format!("{first}–{last} {name}"),
            };
            let key: Vec<String> = key.iter().map(entry).collect();
            Label::new(&key.join(",  "), SMALL).draw_within(canvas, at, panel.width + 8.0);
        }
    }

    fn draw_stage(&self, canvas: &mut Canvas, panel: &Panel, stage: &HistoryStage) {
        let points = |score: fn(&HistoryGeneration) -> f64| -> Vec<Point> {
            let all = stage.generations.iter().map(|g| [g.at, score(g)]);
            let finite: Vec<Point> = all.filter(|p| p.iter().all(|c| c.is_finite())).collect();
            panel.path(&finite)
        };
        let mut band = points(|g| g.quartiles[0]);
        band.extend(points(|g| g.quartiles[1]).into_iter().rev());
        canvas.fill(&band, translucent(SKY, 0.35));
        let curves = [
            (points(|g| g.median), 0.9, ORANGE),
            (points(|g| g.best), 1.3, BLUE),
        ];
        for (path, width, colour) in curves {
            canvas.stroke(&path, width, colour);
            // One point has no line.
            if let [only] = path.as_slice() {
                canvas.disc(*only, 1.6, colour);
            }
        }
    }

    fn draw_reported(&self, canvas: &mut Canvas, panel: &Panel) {
        let Some([value, error]) = self.reported.filter(|[value, _]| value.is_finite()) else {
            return;
        };
        let at = |y: f64| panel.at(panel.x[0], y)[1];
        if error.is_finite() && error > 0.0 {
            let (top, bottom) = (at(value + error), at(value - error));
            let band = rectangle(panel.left, top, panel.width, bottom - top);
            canvas.fill(&band, translucent(GREEN, 0.3));
        }
        let y = at(value);
        canvas.stroke(
            &[[panel.left, y], [panel.left + panel.width, y]],
            1.0,
            GREEN,
        );
    }

    fn draw_legend(&self, canvas: &mut Canvas) {
        let reported = self
            .reported
            .map(|[value, error]| format!("held out: {}", self.printed(value, error)));
        let mut entries = vec![
            (Swatch::Line(BLUE), "best of the generation"),
            (Swatch::Line(ORANGE), "median"),
            (
                Swatch::Area(translucent(SKY, 0.35), translucent(SKY, 0.35)),
                "middle half",
            ),
        ];
        if let Some(reported) = &reported {
            entries.push((Swatch::Line(GREEN), reported));
        }
        let at = [20.0, self.title_height() + MARGIN + 2.0];
        legend(canvas, at, COLUMN - 20.0 - MARGIN, 2, &entries);
    }

    fn printed(&self, value: f64, error: f64) -> String {
        let text = with_error(value, error);
        match self.unit.as_str() {
            "" => text,
            unit if text.contains('±') && unit != "%" => format!("({text}) {unit}"),
            unit => format!("{text} {unit}"),
        }
    }
}

impl Figure for SearchHistoryFigure {
    fn name(&self) -> &str {
        "history"
    }

    fn caption(&self) -> String {
        let names = self.stages.iter().map(|stage| stage.name.as_str());
        let mut names: Vec<&str> = names.collect();
        names.dedup();
        let stages = match names.is_empty() {
            true => String::new(),
            false => format!(" in the stages {}", names.join(", ")),
        };
        let mut text = format!(
            "Scores of every generation as the search saw them{stages}: the best, the median and the \
             middle half."
        );
        if let Some([value, error]) = self.reported {
            text += &format!(
                " Green: the winner on samples that the search has not seen, {}, with its standard \
                 error; what the best scores exceed it by is the search's optimism.",
                self.printed(value, error)
            );
        }
        text
    }

    fn size(&self) -> Size {
        Size {
            width: COLUMN,
            height: self.panel().top + HEIGHT + BOTTOM,
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let title = Label::new(&self.title, TITLE).bold().align(HPos::Center);
        title.draw_within(canvas, [0.5 * COLUMN, 11.0], COLUMN - 2.0 * MARGIN);
        self.draw_legend(canvas);
        let panel = self.panel();
        let y_ticks = ticks::round(panel.y[0], panel.y[1], 5);
        let x_ticks = ticks::round(panel.x[0], panel.x[1], 5);
        panel.grid(canvas, &y_ticks);
        self.draw_stages(canvas, &panel);
        self.draw_reported(canvas, &panel);
        for stage in &self.stages {
            self.draw_stage(canvas, &panel, stage);
        }
        if self.generations().next().is_none() {
            panel.remark(canvas, "no data");
        }
        panel.axes(canvas, &x_ticks, &y_ticks, true);
        panel.x_label(canvas, &self.axis_label);
        panel.y_label(canvas, &with_unit(&self.score_label, &self.unit), &y_ticks);
    }

    fn table(&self) -> Table {
        let mut table = Table::new(&[
            "stage",
            "at",
            "best",
            "median",
            "lower_quartile",
            "upper_quartile",
            "error",
        ]);
        for stage in &self.stages {
            for g in &stage.generations {
                let numbers = [g.at, g.best, g.median, g.quartiles[0], g.quartiles[1]];
                let mut row = vec![stage.name.clone()];
                row.extend(numbers.map(cell));
                row.push(String::new());
                table.rows.push(row);
            }
        }
        if let Some([value, error]) = self.reported {
            let none = String::new;
            let row = [
                "reported".into(),
                none(),
                cell(value),
                none(),
                none(),
                none(),
                cell(error),
            ];
            table.rows.push(row.to_vec());
        }
        table
    }
}
