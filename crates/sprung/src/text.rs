//! Numbers for people.

/// Six significant digits, without zeros at the end; a power of ten where it is very large or small.
///
/// ```
/// use sprung::significant;
/// assert_eq!(significant(0.1 + 0.2), "0.3");
/// assert_eq!(significant(8643.983354), "8643.98");
/// assert_eq!(significant(3.9e-8), "3.9e-8");
/// ```
pub fn significant(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    if rounded != 0.0 && !(1e-4..1e9).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        rounded.to_string()
    }
}

/// Two significant digits, downwards.
pub(crate) fn round_down(value: f64) -> f64 {
    let digits = format!("{value:.9e}");
    let cut = digits.split_once('e').map(|(mantissa, exponent)| format!("{}e{exponent}", &mantissa[..3]));
    cut.and_then(|digits| digits.parse().ok()).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_down_never_rounds_up() {
        for (value, rounded) in
            [(0.0119, 0.011), (0.0110305, 0.011), (9.99e-7, 9.9e-7), (1.0, 1.0), (57.0, 57.0)]
        {
            assert_eq!(round_down(value), rounded);
        }
    }
}
