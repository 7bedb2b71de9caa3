//! A zip archive whose entries are stored as they are: just enough of the format for `.npz` files of any size.
//!
//! Entries are written with a header of fixed length that is filled in once the entry's size and checksum are known, so
//! an entry may grow for as long as a run goes on. Sizes over 4 GiB use the format's 64-bit fields ("zip64").
//! The format is PKWARE's APPNOTE 6.3; section numbers below are its.

use std::io::{self, Seek, SeekFrom, Write};

/// Version 4.5 of the format, the first with 64-bit sizes.
const VERSION: u16 = 45;
/// 1 January 1980, the first day the format knows: the same run makes the same bytes on any day.
const DATE: u16 = 0x0021;
/// Stands in a 32-bit field whose value is in the 64-bit extra field.
const SEE_EXTRA: u32 = u32::MAX;

/// What an entry of the archive is called, where it lies, and what is in it.
#[derive(Clone, Debug)]
struct Entry {
    name: &'static str,
    offset: u64,
    bytes: u64,
    crc32: u32,
}

/// An archive being written.
#[derive(Debug)]
pub struct StoredZip<W> {
    out: W,
    entries: Vec<Entry>,
    /// Where the entries that are complete end.
    end: u64,
}

/// Bytes before the content of an entry.
pub const fn header_bytes(name: &str) -> u64 {
    30 + name.len() as u64 + 20
}

impl<W: Write + Seek> StoredZip<W> {
    /// An empty archive, at the start of `out`.
    pub fn new(out: W) -> Self {
        Self { out, entries: Vec::new(), end: 0 }
    }

    /// What the archive is written to. The content of an entry is written here, after [`begin`](Self::begin).
    pub fn out(&mut self) -> &mut W {
        &mut self.out
    }

    /// Begins an entry behind the others and tells where its content starts.
    pub fn begin(&mut self, name: &'static str) -> io::Result<u64> {
        let offset = self.out.seek(SeekFrom::Start(self.end))?;
        let entry = Entry { name, offset, bytes: 0, crc32: 0 };
        self.out.write_all(&entry.local_header())?;
        self.entries.push(entry);
        self.out.stream_position()
    }

    /// Completes the entry begun last, whose content has the given length and checksum and lies in its place.
    pub fn end(&mut self, bytes: u64, crc32: u32) -> io::Result<()> {
        let Some(entry) = self.entries.last_mut() else { return Ok(()) };
        (entry.bytes, entry.crc32) = (bytes, crc32);
        self.out.seek(SeekFrom::Start(entry.offset))?;
        self.out.write_all(&entry.local_header())?;
        self.end = entry.offset + header_bytes(entry.name) + bytes;
        self.out.seek(SeekFrom::Start(self.end))?;
        Ok(())
    }

    /// Writes the directory, which ends the archive, and gives back what it was written to.
    pub fn finish(mut self) -> io::Result<W> {
        let start = self.out.seek(SeekFrom::Start(self.end))?;
        for entry in &self.entries {
            self.out.write_all(&entry.directory_record())?;
        }
        let end = self.out.stream_position()?;
        self.out.write_all(&end_of_directory(self.entries.len() as u16, start, end))?;
        Ok(self.out)
    }
}

/// The size of an archive with entries of these names and lengths.
pub fn size(entries: &[(&'static str, u64)]) -> u64 {
    let (mut offset, mut directory) = (0, 0);
    for &(name, bytes) in entries {
        let entry = Entry { name, offset, bytes, crc32: 0 };
        offset += entry.local_header().len() as u64 + bytes;
        directory += entry.directory_record().len() as u64;
    }
    let end = offset + directory;
    end + end_of_directory(entries.len() as u16, offset, end).len() as u64
}

impl Entry {
    /// §4.3.7. Always with the 64-bit extra field: the size is not known when the header is first written.
    fn local_header(&self) -> Vec<u8> {
        let mut header = Vec::with_capacity(64);
        put32(&mut header, 0x0403_4b50);
        self.put_common(&mut header, SEE_EXTRA, 20);
        header.extend(self.name.as_bytes());
        put16(&mut header, 1); // the 64-bit extra field …
        put16(&mut header, 16); // … of two numbers
        put64(&mut header, self.bytes);
        put64(&mut header, self.bytes);
        header
    }

    /// §4.3.12. With 64-bit numbers only where they are needed, as some readers know only the old fields.
    fn directory_record(&self) -> Vec<u8> {
        let wide = self.bytes.max(self.offset) >= u64::from(SEE_EXTRA);
        let narrow = |value: u64| if wide { SEE_EXTRA } else { value as u32 };
        let mut record = Vec::with_capacity(96);
        put32(&mut record, 0x0201_4b50);
        put16(&mut record, VERSION);
        self.put_common(&mut record, narrow(self.bytes), if wide { 28 } else { 0 });
        put16(&mut record, 0); // length of the comment
        put16(&mut record, 0); // disk
        put16(&mut record, 0); // internal attributes
        put32(&mut record, 0); // external attributes
        put32(&mut record, narrow(self.offset));
        record.extend(self.name.as_bytes());
        if wide {
            put16(&mut record, 1);
            put16(&mut record, 24);
            put64(&mut record, self.bytes);
            put64(&mut record, self.bytes);
            put64(&mut record, self.offset);
        }
        record
    }

    /// The fields that a local header and a directory record share, from the version to the extra field's length.
    fn put_common(&self, out: &mut Vec<u8>, size: u32, extra_bytes: u16) {
        put16(out, VERSION);
        put16(out, 0); // flags
        put16(out, 0); // method: stored
        put16(out, 0); // time
        put16(out, DATE);
        put32(out, self.crc32);
        put32(out, size); // compressed
        put32(out, size); // and not
        put16(out, self.name.len() as u16);
        put16(out, extra_bytes);
    }
}

/// §4.3.14 to §4.3.16: where the directory lies, with 64-bit numbers only where they are needed.
fn end_of_directory(entries: u16, start: u64, end: u64) -> Vec<u8> {
    let wide = start >= u64::from(SEE_EXTRA);
    let mut record = Vec::with_capacity(100);
    if wide {
        put32(&mut record, 0x0606_4b50);
        put64(&mut record, 44); // bytes that follow
        put16(&mut record, VERSION);
        put16(&mut record, VERSION);
        put32(&mut record, 0); // this disk
        put32(&mut record, 0); // the directory's disk
        put64(&mut record, u64::from(entries)); // on this disk
        put64(&mut record, u64::from(entries)); // and in all
        put64(&mut record, end - start);
        put64(&mut record, start);
        put32(&mut record, 0x0706_4b50); // how to find the record above
        put32(&mut record, 0);
        put64(&mut record, end);
        put32(&mut record, 1); // disks
    }
    put32(&mut record, 0x0605_4b50);
    put16(&mut record, 0);
    put16(&mut record, 0);
    put16(&mut record, entries);
    put16(&mut record, entries);
    put32(&mut record, (end - start) as u32);
    put32(&mut record, if wide { SEE_EXTRA } else { start as u32 });
    put16(&mut record, 0); // length of the comment
    record
}

fn put16(out: &mut Vec<u8>, value: u16) {
    out.extend(value.to_le_bytes());
}

fn put32(out: &mut Vec<u8>, value: u32) {
    out.extend(value.to_le_bytes());
}

fn put64(out: &mut Vec<u8>, value: u64) {
    out.extend(value.to_le_bytes());
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read};

    use super::*;

    #[test]
    fn another_reader_finds_the_entries_and_their_checksums_right() {
        let mut zip = StoredZip::new(Cursor::new(Vec::new()));
        for (name, content) in [("a.txt", "one"), ("b.txt", ""), ("c.txt", "three\n")] {
            zip.begin(name).expect("memory takes everything");
            zip.out().write_all(content.as_bytes()).expect("memory takes everything");
            zip.end(content.len() as u64, crc32fast::hash(content.as_bytes()))
                .expect("memory takes everything");
        }
        let file = zip.finish().expect("memory takes everything");

        let mut archive = zip::ZipArchive::new(file).expect("a zip archive");
        for (name, content) in [("a.txt", "one"), ("b.txt", ""), ("c.txt", "three\n")] {
            let mut read = String::new();
            archive.by_name(name).expect("the entry").read_to_string(&mut read).expect("the checksum fits");
            assert_eq!(read, content);
        }
    }

    /// Five thousand million zeros, as a hole in a file that takes no room on the disk.
    #[test]
    fn entries_over_4_gib_and_those_behind_them_are_found() {
        const HUGE: u64 = 5_000_000_000;
        let mut zip = StoredZip::new(tempfile::tempfile().expect("a temporary file"));
        let start = zip.begin("huge").expect("written");
        zip.out().seek(SeekFrom::Start(start + HUGE - 1)).expect("moved");
        zip.out().write_all(&[0]).expect("written");
        zip.end(HUGE, 0).expect("written"); // the checksum is not what is looked at here
        zip.begin("small").expect("written");
        zip.out().write_all(b"behind").expect("written");
        zip.end(6, crc32fast::hash(b"behind")).expect("written");
        let file = zip.finish().expect("written");

        let mut archive = zip::ZipArchive::new(file).expect("a zip archive");
        assert_eq!(archive.by_name("huge").expect("the entry").size(), HUGE);
        let mut read = String::new();
        archive.by_name("small").expect("the entry").read_to_string(&mut read).expect("the checksum fits");
        assert_eq!(read, "behind");
    }
}
