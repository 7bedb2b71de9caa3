//! A guard against getting slower that no busy machine disturbs: how many instructions the engine takes.
//!
//! The program [`PROGRAM`] does what is to be counted, valgrind's callgrind counts, and a table in [`PAGE`] says what is
//! expected. The counts are the same at every run; they change with the code, with the compiler that rust-toolchain.toml
//! names, and, where memory is taken, a little with the system's C library.

use std::fs;
use std::path::Path;

use crate::shell::{Outcome, cargo, program, read, root, run, succeeds, target};
use crate::stages::fresh_folder;

/// How far a count may be from what is expected, %. A count that fell fails too: kept as the new expectation, it is what
/// the next change is held against.
const TOLERANCE: f64 = 3.0;

/// An example of the engine.
const PROGRAM: &str = "instructions";

/// Where the expected counts are: the table below this heading.
const PAGE: &str = "docs/benchmarks.md";
const HEADING: &str = "## Instruction counts\n";

/// With this variable the found counts become the expected ones.
const UPDATE: &str = "SPRUNG_UPDATE_COUNTS";

/// How many instructions some work takes.
struct Count {
    /// Scene, work and level of vector instructions, as the table's columns have them.
    name: [String; 3],
    /// For each spring, with four digits.
    instructions: String,
}

/// Counts, and compares with the table.
pub fn instructions() -> Outcome {
    if !cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        println!("Nothing is counted here: the expected counts are those of Linux on x86-64.");
        return Ok(());
    }
    #[cfg(target_arch = "x86_64")]
    if !std::arch::is_x86_feature_detected!("avx2") {
        println!("Nothing is counted here: the expected counts are those of a processor with AVX2.");
        return Ok(());
    }
    let found = count()?;
    let path = root().join(PAGE);
    let page = fs::read_to_string(&path).map_err(|error| format!("{PAGE} cannot be read: {error}"))?;
    let [before, table, after] = split(&page)?;
    let misfits = compare(&expected(table), &found);
    if std::env::var_os(UPDATE).is_some() {
        fs::write(&path, format!("{before}{}{after}", table_of(&found)))
            .map_err(|error| format!("{PAGE} cannot be written: {error}"))?;
        println!("{PAGE} has the counts that were found: look at what changed before you commit it.");
        return Ok(());
    }
    if misfits == 0 {
        return Ok(());
    }
    Err(format!(
        "{misfits} counts are not within {TOLERANCE} % of those in {PAGE}; if that is meant, `{UPDATE}=1 cargo xtask \
         instructions` writes them anew"
    ))
}

/// Builds the program as it is shipped, and runs it under callgrind.
fn count() -> Outcome<Vec<Count>> {
    if !succeeds(&mut program("valgrind", &["--version"])) {
        return Err("valgrind is missing; `sudo apt-get install valgrind` brings it".to_owned());
    }
    run(cargo(&["build", "--locked", "--release", "-p", "sprung", "--example", PROGRAM])
        // Not for another processor, nor in another way, than everybody else's.
        .env_remove("RUSTFLAGS")
        .env_remove("CARGO_ENCODED_RUSTFLAGS"))?;
    let counts = fresh_folder("instructions")?.join("callgrind.out");
    let mut valgrind = program("valgrind", &["--quiet", "--tool=callgrind", "--combine-dumps=yes"]);
    valgrind
        .arg(format!("--callgrind-out-file={}", counts.display()))
        .arg(format!("--toggle-collect=*{PROGRAM}::counted*"))
        .arg(format!("--dump-before=*{PROGRAM}::tell*"))
        .arg(target().join("release/examples").join(PROGRAM))
        // The C library shall copy and clear with vectors: an instruction that does it for a whole array, which many
        // processors have, counts once for each byte here.
        .env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-ERMS");
    let told = read(&mut valgrind)?;
    let told = String::from_utf8_lossy(&told);
    let sums = sums(&counts)?;
    if sums.len() != told.lines().count() || sums.contains(&0) {
        return Err(format!("valgrind does not see where {PROGRAM} begins and ends a count: {sums:?}"));
    }
    let counts = told.lines().zip(sums).map(|(line, sum)| {
        let [scene, work, level, springs] = line.split('\t').collect::<Vec<_>>().try_into().ok()?;
        let instructions = four_digits(sum as f64 / springs.parse::<f64>().ok()?);
        Some(Count { name: [scene, work, level].map(str::to_owned), instructions })
    });
    counts.collect::<Option<_>>().ok_or_else(|| format!("{PROGRAM} does not say what it did: {told}"))
}

/// The instructions of each count, in order. Callgrind closes one at each call of the function that tells what it was, and
/// a last one at the program's end.
fn sums(counts: &Path) -> Outcome<Vec<u64>> {
    let text = fs::read_to_string(counts).map_err(|error| format!("callgrind left no counts: {error}"))?;
    let mut sums: Vec<u64> = text
        .lines()
        .filter_map(|line| line.strip_prefix("summary: "))
        .filter_map(|sum| sum.trim().parse().ok())
        .collect();
    sums.pop();
    Ok(sums)
}

/// Prints both side by side. Returns how many are beyond the tolerance, or only on one side.
fn compare(expected: &[Count], found: &[Count]) -> usize {
    let mut misfits = 0;
    let mut row = |[scene, work, level]: &[String; 3], expected: &str, found: &str| {
        let change = match (expected.parse::<f64>(), found.parse::<f64>()) {
            (Ok(expected), Ok(found)) => Some(100.0 * (found / expected - 1.0)),
            _ => None,
        };
        let verdict = match change {
            Some(change) if change.abs() <= TOLERANCE => "",
            Some(change) if change < 0.0 => "FASTER",
            Some(_) => "SLOWER",
            None if found.is_empty() => "NOT COUNTED",
            None => "NOT EXPECTED",
        };
        misfits += usize::from(!verdict.is_empty());
        let change = change.map(|change| format!("{change:+.1} %")).unwrap_or_default();
        let line =
            format!("{scene:<10} {work:<23} {level:<5} {expected:>9} {found:>9} {change:>9}  {verdict}");
        println!("{}", line.trim_end());
    };
    println!("{:<40} {:>9} {:>9} {:>9}", "instructions for each spring", "expected", "found", "change");
    for count in found {
        let expected = expected.iter().find(|expected| expected.name == count.name);
        row(&count.name, expected.map_or("", |expected| &expected.instructions), &count.instructions);
    }
    for count in expected.iter().filter(|count| found.iter().all(|found| found.name != count.name)) {
        row(&count.name, &count.instructions, "");
    }
    misfits
}

/// The page before the table, the table, and what comes after it.
fn split(page: &str) -> Outcome<[&str; 3]> {
    let heading =
        page.find(HEADING).ok_or_else(|| format!("{PAGE} has no heading \"{}\"", HEADING.trim()))?;
    let table = page[heading..].find("\n|").ok_or_else(|| format!("{PAGE} has no table of instructions"))?;
    let table = heading + table + 1;
    let length: usize =
        page[table..].split_inclusive('\n').take_while(|line| line.starts_with('|')).map(str::len).sum();
    let (table, after) = page[table..].split_at(length);
    Ok([&page[..page.len() - table.len() - after.len()], table, after])
}

/// What a table says, but for its head.
fn expected(table: &str) -> Vec<Count> {
    let rows = table.lines().skip(2).filter_map(|line| {
        let cells: Vec<String> =
            line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect();
        let [scene, work, level, instructions] = <[String; 4]>::try_from(cells).ok()?;
        Some(Count { name: [scene, work, level], instructions })
    });
    rows.collect()
}

/// The table that says this.
fn table_of(counts: &[Count]) -> String {
    let mut table =
        "| scene | work | level | instructions for each spring |\n|---|---|---|---:|\n".to_owned();
    for Count { name, instructions } in counts {
        table += &format!("| {} | {instructions} |\n", name.join(" | "));
    }
    table
}

/// A positive number, written with at least four digits.
fn four_digits(number: f64) -> String {
    let before_the_point = number.log10().floor().max(0.0) as usize + 1;
    format!("{number:.*}", 4usize.saturating_sub(before_the_point))
}
