//! The archive that a `.usdz` is: a zip file whose entries are stored as they are, each beginning at a multiple of 64
//! bytes so that it can be used where it lies.
//!
//! After the "Usdz File Format Specification" 1.3 of OpenUSD and section 4.3 of PKWARE's APPNOTE 6.3. Readers of these
//! archives know no 64-bit sizes and look at the headers before the entries, not at the directory behind them: so it is not
//! the archive of [`stored_zip`](crate::export::stored_zip), which is for files of any size.

use std::io::{self, Seek, SeekFrom, Write};

/// Where entries may begin.
const ALIGNMENT: usize = 64;
/// The fixed part of the header before an entry.
const HEADER_BYTES: usize = 30;
/// Version 1.0 of the format: entries stored as they are.
const VERSION: u16 = 10;
/// 1 January 1980, the first day the format knows: the same run makes the same bytes on any day.
const DATE: u16 = 0x0021;
/// An "extra field" with this number is only there to fill a gap; OpenUSD takes the same.
const PADDING: u16 = 0x1986;
/// The most that is written besides an entry: headers with a long name, twice.
pub const MOST_BYTES: u64 = 1 << 10;
/// The most that an entry may hold, so that all sizes and places fit in 32 bits.
pub const MOST_CONTENT_BYTES: u64 = u32::MAX as u64 - MOST_BYTES;

/// An archive of one entry.
pub struct Package {
    name: String,
}

impl Package {
    /// With an entry of this name.
    pub fn new(name: String) -> Self {
        Self { name }
    }

    /// Where the entry's content begins.
    pub fn content_start(&self) -> u64 {
        // An extra field has four bytes of its own.
        (HEADER_BYTES + self.name.len() + 4).next_multiple_of(ALIGNMENT) as u64
    }

    /// How long the archive is besides its content: headers, a directory of one record, and its end.
    pub fn bytes_around(&self) -> u64 {
        self.content_start() + (46 + self.name.len() + 22) as u64
    }

    /// Fills in the header before the content, which is in its place, and writes the directory behind it.
    pub fn close(&self, out: &mut (impl Write + Seek), bytes: u64, crc32: u32) -> io::Result<()> {
        let too_large = |_| io::Error::from(io::ErrorKind::FileTooLarge);
        let (start, bytes) = (self.content_start(), u32::try_from(bytes).map_err(too_large)?);

        let padding = start as usize - HEADER_BYTES - self.name.len();
        let mut header = 0x0403_4b50_u32.to_le_bytes().to_vec();
        self.put_common(&mut header, bytes, crc32, padding);
        header.extend(self.name.as_bytes());
        put16(&mut header, PADDING);
        put16(&mut header, padding as u16 - 4);
        header.resize(start as usize, 0);
        out.seek(SeekFrom::Start(0))?;
        out.write_all(&header)?;

        // The directory, with its one record, and its end.
        let directory = out.seek(SeekFrom::End(0))?;
        let mut record = 0x0201_4b50_u32.to_le_bytes().to_vec();
        put16(&mut record, VERSION);
        self.put_common(&mut record, bytes, crc32, 0);
        record.extend([0; 2 + 2 + 2 + 4]); // comment, disk, attributes
        record.extend(0_u32.to_le_bytes()); // where the header is
        record.extend(self.name.as_bytes());
        let mut end = 0x0605_4b50_u32.to_le_bytes().to_vec();
        end.extend([0; 4]); // this disk, and that of the directory
        put16(&mut end, 1); // records here
        put16(&mut end, 1); // and in all
        end.extend((record.len() as u32).to_le_bytes());
        end.extend(u32::try_from(directory).map_err(too_large)?.to_le_bytes());
        put16(&mut end, 0); // comment
        out.write_all(&record)?;
        out.write_all(&end)
    }

    /// The fields that header and record share, from the version to the extra field's length.
    fn put_common(&self, out: &mut Vec<u8>, bytes: u32, crc32: u32, extra_bytes: usize) {
        put16(out, VERSION);
        put16(out, 0); // flags
        put16(out, 0); // method: stored
        put16(out, 0); // time
        put16(out, DATE);
        out.extend(crc32.to_le_bytes());
        out.extend(bytes.to_le_bytes()); // compressed
        out.extend(bytes.to_le_bytes()); // and not
        put16(out, self.name.len() as u16);
        put16(out, extra_bytes as u16);
    }
}

fn put16(out: &mut Vec<u8>, value: u16) {
    out.extend(value.to_le_bytes());
}
