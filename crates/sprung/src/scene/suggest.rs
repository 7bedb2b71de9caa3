//! "Did you mean": the known name that is nearest to one that was typed.

/// Longer names are not compared: nobody mistypes them, and the comparison takes quadratic time.
const LONGEST: usize = 64;

/// The candidate nearest to `name`, if it is near enough that it may have been meant.
///
/// ```
/// use sprung::scene::closest;
/// assert_eq!(closest("stifness", ["stiffness", "damping"]), Some("stiffness"));
/// assert_eq!(closest("colour", ["stiffness", "damping"]), None);
/// ```
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if name.len() > LONGEST {
        return None;
    }
    let name = name.to_lowercase();
    let length = name.chars().count();
    let near = (length / 3).max(1);
    candidates
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(&name, &candidate.to_lowercase()), candidate))
        .filter(|&(distance, _)| distance <= near && distance < length)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, candidate)| candidate)
}

/// The fix that goes with [`closest`], if there is one.
pub(super) fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<String> {
    closest(name, candidates).map(|candidate| format!("did you mean \"{candidate}\"?"))
}

/// What was typed, fit to be quoted in a sentence: short, and on one line of a terminal.
pub(super) fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    if text.chars().count() <= MOST {
        return one_line(text);
    }
    one_line(&text.chars().take(MOST).chain(['…']).collect::<String>())
}

/// A text without characters that steer a terminal: those are written as `\n` or `\u{1b}`.
pub(super) fn one_line(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for letter in text.chars() {
        match steers(letter) {
            true => line.extend(letter.escape_default()),
            false => line.push(letter),
        }
    }
    line
}

/// Whether a character is not shown but changes what is: a control character, a line break, or one of those that turn
/// the direction of the text around them.
pub(super) fn steers(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{61c}' | '\u{200b}' | '\u{200e}' | '\u{200f}' | '\u{feff}')
        || ('\u{2028}'..='\u{202e}').contains(&letter)
        || ('\u{2060}'..='\u{206f}').contains(&letter)
}
