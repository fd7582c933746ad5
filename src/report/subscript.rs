//! Subscripts: "W_F" reads W with a small F below. plotters writes lines of one size only, so an
//! index travels through it between two marks, which become an SVG `tspan` afterwards. All of a
//! line stays one SVG text, whose anchor is exact in any font.

/// Marks before and after an index; private characters without any sign in the fonts.
const MARKS: [char; 2] = ['\u{e000}', '\u{e001}'];

/// What the marks become: 0.72 of the size, 0.2 of the line's size below the base line.
const TAGS: [&str; 2] = [
    "<tspan font-size=\"72%\" dy=\"0.2778em\">",
    "</tspan><tspan dy=\"-0.2em\">",
];

/// Sets the character after `_` as an index where a letter comes before; a space for every
/// character that XML does not allow, that breaks the line, or that is a mark.
pub(super) fn marked(text: &str) -> String {
    let is_odd = |c: char| c.is_control() || MARKS.contains(&c) || "\u{fffe}\u{ffff}".contains(c);
    let text = text.replace(is_odd, " ");
    let mut out = String::new();
    let mut characters = text.chars().peekable();
    let mut is_after_letter = false;
    while let Some(c) = characters.next() {
        let index =
            characters.next_if(|next| c == '_' && is_after_letter && next.is_alphanumeric());
        match index {
            Some(index) => out.extend([MARKS[0], index, MARKS[1]]),
            None => out.push(c),
        }
        is_after_letter = index.is_none() && c.is_alphabetic();
    }
    out
}

/// Replaces the marks in an SVG document.
pub(super) fn with_tags(svg: &str) -> String {
    let mut out = String::with_capacity(svg.len());
    for line in svg.split_inclusive("</text>") {
        let count = line.matches(MARKS[1]).count();
        let line = line.replace(MARKS[0], TAGS[0]).replace(MARKS[1], TAGS[1]);
        let end = format!("{}</text>", "</tspan>".repeat(count));
        out.push_str(&line.replace("</text>", &end));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_follows_a_letter() {
        assert_eq!(marked("size S_F (m²)"), "size S\u{e000}F\u{e001} (m²)");
        assert_eq!(marked("_x 1_2 a_ é__"), "_x 1_2 a_ é__");
        assert_eq!(marked("a_b_c"), "a\u{e000}b\u{e001}_c");
        assert_eq!(marked("\u{e000}\n\u{0}x"), "   x");
    }

    #[test]
    fn tags_are_closed_within_their_text() {
        let svg = with_tags(&format!(
            "<text>{}</text><text>b</text>",
            marked("a_1 b_2 c")
        ));
        assert_eq!(svg.matches("<tspan").count(), 4);
        assert_eq!(svg.matches("</tspan>").count(), 4);
        assert!(svg.ends_with("</tspan></tspan></text><text>b</text>"));
    }
}
