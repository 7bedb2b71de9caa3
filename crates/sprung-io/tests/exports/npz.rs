//! Reads `.npz` files back, with a zip reader that shares nothing with the writer.

use std::fs::File;
use std::io::Read;
use std::path::Path;

/// One array: its type, its shape and its bytes.
pub struct Array {
    pub kind: String,
    pub shape: Vec<usize>,
    pub bytes: Vec<u8>,
}

impl Array {
    pub fn f32s(&self) -> Vec<f32> {
        assert_eq!(self.kind, "<f4");
        self.bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
    }

    pub fn u32s(&self) -> Vec<u32> {
        assert_eq!(self.kind, "<u4");
        self.bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
    }

    pub fn f64s(&self) -> Vec<f64> {
        assert_eq!(self.kind, "<f8");
        let number = |b: &[u8]| f64::from_le_bytes(b.try_into().expect("eight bytes"));
        self.bytes.chunks_exact(8).map(number).collect()
    }
}

/// The array called `name`.
pub fn load(path: &Path, name: &str) -> Array {
    let mut archive =
        zip::ZipArchive::new(File::open(path).expect("the file is there")).expect("a zip archive");
    let mut file = Vec::new();
    // Reading to the end compares the checksum.
    archive
        .by_name(&format!("{name}.npy"))
        .expect("the array is there")
        .read_to_end(&mut file)
        .expect("readable");

    assert_eq!(&file[..8], b"\x93NUMPY\x01\x00");
    let header_end = 10 + usize::from(u16::from_le_bytes([file[8], file[9]]));
    assert_eq!(header_end % 64, 0, "the data of a .npy file are aligned");
    let header = std::str::from_utf8(&file[10..header_end]).expect("ASCII");
    let between = |from: &str, to: &str| {
        let rest = &header[header.find(from).expect("the key is there") + from.len()..];
        rest[..rest.find(to).expect("the value ends")].to_owned()
    };
    let shape = between("'shape': (", ")");
    let array = Array {
        kind: between("'descr': '", "'"),
        shape: shape.split(',').filter_map(|length| length.trim().parse().ok()).collect(),
        bytes: file[header_end..].to_vec(),
    };
    assert!(header.contains("'fortran_order': False") && header.ends_with('\n'));
    array
}
