//! Guesses what a misspelt word was meant to be.

/// The known word most like `word`; `None` only if nothing is known.
///
/// Ties go to the word listed first.
pub fn nearest<'k>(word: &str, known: &[&'k str]) -> Option<&'k str> {
    let likeness = |candidate: &str| strsim::normalized_damerau_levenshtein(word, candidate);
    let mut best: Option<(f64, &'k str)> = None;
    // A word of a kilobyte is no misspelling, and the distance costs the product of the lengths.
    if word.len() > 256 {
        return known.first().copied();
    }
    for &candidate in known {
        let score = likeness(candidate);
        if best.is_none_or(|(top, _)| score > top) {
            best = Some((score, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_word_with_a_slip() {
        let known = ["lower_deg", "upper_deg"];
        assert_eq!(nearest("uper_deg", &known), Some("upper_deg"));
        assert_eq!(nearest("lower", &known), Some("lower_deg"));
        assert_eq!(nearest("", &known), Some("lower_deg"));
        assert_eq!(nearest("x", &[]), None);
    }
}
