//! Every way to write a motion out: the one list that the command, its help and the tests read.

mod gif;
mod mp4;
mod png;
mod recording;
mod spool;

use std::ops::{ControlFlow, RangeInclusive};
use std::path::Path;

use sprung::{Code, Error, Result};
use sprung_io::export::{CSV, GLB, MDD, NPZ, OBJ, PC2, PLY, USDA, USDC, USDZ, VTK};
use sprung_io::{Estimate, Exporter, Options};

pub use gif::GIF;
pub use mp4::MP4;
pub use png::{PNG, write_png};
pub use recording::{Progressed, Recording, Writing};

/// All exporters, chosen by the ending of a file's name.
pub static EXPORTERS: &[Exporter] =
    &[CSV, NPZ, USDC, USDA, USDZ, GLB, PC2, MDD, OBJ, PLY, VTK, PNG, GIF, MP4];

/// Allowed widths and heights of pictures, pixels.
pub const SIZE_RANGE: RangeInclusive<u32> = 16..=8192;

/// The exporter for a file's name, by its ending (in small or capital letters).
///
/// # Errors
/// [`Code::Unsupported`], listing the endings there are.
pub fn exporter_for(path: &Path) -> Result<&'static Exporter> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    let known =
        ending.as_deref().and_then(|ending| EXPORTERS.iter().find(|exporter| exporter.ending == ending));
    known.ok_or_else(|| {
        let found = ending.map_or("no ending".to_owned(), |ending| format!("the ending .{ending}"));
        let endings: Vec<String> = EXPORTERS.iter().map(|exporter| format!(".{}", exporter.ending)).collect();
        Error::new(
            Code::Unsupported,
            format!("has {found}, and the endings that can be written are {}", endings.join(", ")),
        )
        .in_file(path.display().to_string())
    })
}

/// The size a user asked for, or a format's own.
fn picture_size(path: &Path, options: &Options, default: [u32; 2]) -> Result<[u32; 2]> {
    let size = options.size.unwrap_or(default);
    if size.iter().all(|side| SIZE_RANGE.contains(side)) {
        return Ok(size);
    }
    let [width, height] = size;
    let (low, high) = (SIZE_RANGE.start(), SIZE_RANGE.end());
    let sentence = format!("is {width}x{height}, and width and height must be from {low} to {high} pixels");
    Err(Error::new(Code::OutOfRange, sentence).at_field("size").in_file(path.display().to_string()))
}

/// About how many bytes pictures take, at so many bytes for each pixel.
fn about(options: &Options, default: [u32; 2], bytes_per_pixel: f64) -> Estimate {
    let [width, height] = options.size.unwrap_or(default).map(f64::from);
    Estimate::About((width * height * bytes_per_pixel) as u64)
}

/// The answer to progress as a result: an error where the drawing of `path` is broken off.
fn go_on(answer: ControlFlow<()>, path: &Path) -> Result<()> {
    if answer.is_continue() {
        return Ok(());
    }
    let sentence = format!("interrupted while {} was being drawn; it is not kept", path.display());
    Err(Error::new(Code::Interrupted, sentence))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_find_their_exporters() {
        for exporter in EXPORTERS {
            let path = format!("some.folder/name.{}", exporter.ending.to_uppercase());
            let found = exporter_for(Path::new(&path)).expect("the ending is in the list");
            assert_eq!(found.ending, exporter.ending);
            assert!(!exporter.description.is_empty());
        }
    }

    #[test]
    fn an_unknown_ending_is_told_which_there_are() {
        let error = exporter_for(Path::new("a.bmp")).map(|_| ()).expect_err("nobody writes .bmp");
        assert_eq!(error.code(), Code::Unsupported);
        assert!(error.to_string().starts_with("a.bmp: has the ending .bmp, and"), "{error}");
        assert!(error.to_string().contains(".gif"), "{error}");
        assert!(exporter_for(Path::new("a")).is_err());
    }

    #[test]
    fn sizes_are_checked() {
        let size =
            |size| picture_size(Path::new("a.png"), &Options { size, ..Options::default() }, [640, 360]);
        assert_eq!(size(None), Ok([640, 360]));
        assert_eq!(size(Some([16, 8192])), Ok([16, 8192]));
        assert!(size(Some([15, 100])).is_err());
        assert!(size(Some([100, 8193])).is_err());
    }
}
