//! Changes a scene file the way a person would: by tables, lines and numbers. Changes of single bytes, which libFuzzer
//! makes, seldom lead from one text that parses to another.

/// Numbers at the edges of what is allowed, and beyond.
const NUMBERS: [&str; 19] = [
    "0",
    "1",
    "2",
    "3",
    "-1",
    "0.5",
    "1.0",
    "-0.0",
    "1e-9",
    "1000",
    "1e3",
    "1e9",
    "1e308",
    "nan",
    "inf",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "[0, 0, 0]",
];

/// Pseudo-random numbers (xorshift, Marsaglia 2003) from libFuzzer's seed, so that a run can be repeated.
struct Random(u32);

impl Random {
    /// A number below `end`, or 0 if that is 0.
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0 as usize % end.max(1)
    }
}

/// The text with one to four changes.
pub fn mutate(text: &[u8], seed: u32) -> Vec<u8> {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9) | 1);
    let mut lines: Vec<Vec<u8>> = text.split(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    for _ in 0..=random.below(4) {
        let (here, there) = (random.below(lines.len()), random.below(lines.len()));
        match random.below(6) {
            0 => copy_table(&mut lines, here, there),
            1 => lines.insert(there, lines[here].clone()),
            2 if lines.len() > 1 => drop(lines.remove(here)),
            3 => lines.swap(here, there),
            // Numbers twice as often as anything else: ranges are most of what is checked.
            _ => replace_number(&mut lines[here], &mut random),
        }
    }
    lines.join(&b'\n')
}

/// Copies the table that `line` is in, header and all, to before another line.
fn copy_table(lines: &mut Vec<Vec<u8>>, line: usize, to: usize) {
    let is_header = |line: &Vec<u8>| line.first() == Some(&b'[');
    let start = (0..=line).rev().find(|&line| is_header(&lines[line])).unwrap_or(0);
    let end = (line + 1..lines.len()).find(|&line| is_header(&lines[line])).unwrap_or(lines.len());
    // To before a header, where a table can stand.
    let to = (to..lines.len()).find(|&line| is_header(&lines[line])).unwrap_or(lines.len());
    let mut table = lines[start..end].to_vec();
    // Two bodies of one name are refused.
    for line in table.iter_mut().filter(|line| line.starts_with(b"name = \"") && line.ends_with(b"\"")) {
        line.insert(line.len() - 1, b'x');
    }
    lines.splice(to..to, table);
}

/// Replaces one of a line's numbers.
fn replace_number(line: &mut Vec<u8>, random: &mut Random) {
    let in_number = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+');
    let starts: Vec<usize> =
        (0..line.len()).filter(|&at| in_number(line[at]) && (at == 0 || !in_number(line[at - 1]))).collect();
    if let Some(&start) = starts.get(random.below(starts.len())) {
        let end = (start..line.len()).find(|&at| !in_number(line[at])).unwrap_or(line.len());
        let number = NUMBERS[random.below(NUMBERS.len())].bytes();
        line.splice(start..end, number);
    }
}
