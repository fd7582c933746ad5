//! Shards of an atlas on disk.
//!
//! One file a shard, written whole or not at all: 64 bytes of header, then the block. A shard
//! that is damaged, of another atlas or of another version is treated as missing. The folder's
//! name is the hash of everything that the content depends on, so that shards from any machine
//! that were built for the same question belong together.

use super::block::BlockView;
use memmap2::Mmap;
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

const MAGIC: [u8; 8] = *b"FSATLAS1";

#[derive(Clone, Copy, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
struct ShardHeader {
    magic: [u8; 8],
    key: [u8; 32],
    shard: u64,
    length: u64,
    checksum: u64,
}

/// Everything an atlas' content depends on, hashed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AtlasKey([u8; 32]);

impl AtlasKey {
    pub(super) fn of(parts: &[u8]) -> AtlasKey {
        AtlasKey(Sha256::digest(parts).into())
    }

    /// Lower-case hexadecimal.
    pub fn hex(&self) -> String {
        self.0.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The folder of one atlas.
#[derive(Clone, Debug)]
pub struct AtlasStore {
    folder: PathBuf,
    key: AtlasKey,
}

/// The bytes of a shard: a file in memory map, or memory of our own.
#[derive(Debug)]
pub(super) enum ShardBytes {
    Mapped(Mmap),
    Owned(Vec<u64>),
}

impl ShardBytes {
    pub fn from_bytes(bytes: &[u8]) -> ShardBytes {
        let words = bytes.chunks_exact(8).map(|chunk| {
            let mut word = [0; 8];
            word.copy_from_slice(chunk);
            u64::from_ne_bytes(word)
        });
        ShardBytes::Owned(words.collect())
    }

    /// The packed block.
    pub fn block(&self) -> &[u8] {
        match self {
            ShardBytes::Mapped(map) => &map[size_of::<ShardHeader>()..],
            ShardBytes::Owned(words) => words.as_bytes(),
        }
    }
}

impl AtlasStore {
    /// The atlas `key` below the cache folder `cache`.
    pub fn new(cache: &Path, key: AtlasKey) -> AtlasStore {
        AtlasStore {
            folder: cache.join(&key.hex()[..16]),
            key,
        }
    }

    /// The folder with the shards.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn path(&self, shard: u64) -> PathBuf {
        self.folder.join(format!("{shard:06}.shard"))
    }

    /// The shard, if it is there and sound.
    pub(super) fn load(&self, shard: u64) -> Option<ShardBytes> {
        load_file(&self.path(shard), self.key, shard)
    }

    /// Writes a shard.
    pub(super) fn save(&self, shard: u64, block: &[u8]) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        let header = ShardHeader {
            magic: MAGIC,
            key: self.key.0,
            shard,
            length: block.len() as u64,
            checksum: u64::from(crc32fast::hash(block)),
        };
        let mut file = tempfile::NamedTempFile::new_in(&self.folder)?;
        file.write_all(header.as_bytes())?;
        file.write_all(block)?;
        file.persist(self.path(shard))
            .map_err(|error| error.error)?;
        Ok(())
    }

    /// How many of the first `shards` shards are not there, or not sound.
    pub fn missing(&self, shards: u64) -> u64 {
        let absent = |shard: &u64| self.load(*shard).is_none();
        (0..shards).filter(absent).count() as u64
    }

    /// Copies every sound shard of this atlas out of `other` (a cache folder or the atlas'
    /// folder itself) that is missing here; returns how many were.
    ///
    /// # Errors
    /// A file could not be written.
    pub fn merge(&self, other: &Path, shards: u64) -> io::Result<u64> {
        let name = self.folder.file_name().unwrap_or_default();
        let nested = other.join(name);
        let source = AtlasStore {
            folder: if nested.is_dir() {
                nested
            } else {
                other.into()
            },
            key: self.key,
        };
        let mut copied = 0;
        for shard in 0..shards {
            if self.load(shard).is_none()
                && let Some(bytes) = source.load(shard)
            {
                self.save(shard, bytes.block())?;
                copied += 1;
            }
        }
        Ok(copied)
    }
}

fn load_file(path: &Path, key: AtlasKey, shard: u64) -> Option<ShardBytes> {
    let file = File::open(path).ok()?;
    // SAFETY: shards are only ever replaced by renaming, never written in place; a file that
    // someone else truncates while it is mapped would end the process.
    let map = unsafe { Mmap::map(&file) }.ok()?;
    let (header, block) = ShardHeader::ref_from_prefix(&map[..]).ok()?;
    let sound = header.magic == MAGIC
        && header.key == key.0
        && header.shard == shard
        && header.length == block.len() as u64
        && header.checksum == u64::from(crc32fast::hash(block))
        && BlockView::new(block).is_some_and(|view| view.is_consistent());
    sound.then(|| ShardBytes::Mapped(map))
}
