//! Numbers as the window writes them: short, with a proper minus sign, and of a width that hardly changes.

use sprung::significant;

/// Less than this is nothing: what rounding leaves where numbers of everyday size cancel.
const NOTHING: f64 = 1e-12;

/// A count with its thousands set apart, by spaces at which no line breaks.
pub fn thousands(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

/// The nearest number of so many significant digits, of which there is at least one.
pub fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// Three significant digits: as many as one takes in at a glance.
pub fn three_digits(value: f64) -> String {
    with_minus(significant(rounded(value, 3)))
}

/// A number that changes while it is read: up to four significant digits, and three decimals.
pub fn steady(value: f64) -> String {
    let size = value.abs();
    with_minus(match size {
        _ if !value.is_finite() => "—".to_owned(),
        _ if size < NOTHING => "0.000".to_owned(),
        _ if !(1e-3..1e6).contains(&size) => format!("{value:.2e}"),
        _ if size >= 1000.0 => format!("{value:.0}"),
        _ if size >= 100.0 => format!("{value:.1}"),
        _ if size >= 10.0 => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    })
}

/// With minus signs, which are as wide as digits, in the place of hyphens.
pub fn with_minus(text: impl Into<String>) -> String {
    text.into().replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_apart() {
        let texts = [5, 999, 7560, 1_234_567].map(thousands);
        assert_eq!(texts, ["5", "999", "7\u{a0}560", "1\u{a0}234\u{a0}567"]);
    }

    #[test]
    fn rounding_keeps_what_it_is_asked_to_keep() {
        assert_eq!([1, 2, 3].map(|digits| rounded(0.012_345, digits)), [0.01, 0.012, 0.0123]);
        assert_eq!(rounded(999.6, 3), 1000.0);
        assert_eq!(rounded(7.0, 0), 7.0);
        assert!(rounded(f64::NAN, 3).is_nan());
        assert_eq!([-0.05, 123_456.0, 2.5e-9].map(three_digits), ["−0.05", "123000", "2.5e−9"]);
    }

    #[test]
    fn steady_numbers_keep_their_width() {
        let texts = [0.0, 1.234_56, -12.3, 123.45, 4567.8, -1e-15].map(steady);
        assert_eq!(texts, ["0.000", "1.235", "−12.30", "123.5", "4568", "0.000"]);
        assert_eq!([1e-5, 2.5e7, f64::NAN].map(steady), ["1.00e−5", "2.50e7", "—"]);
    }
}
