//! A quick hash for keys that are numbers and come from the planner itself.
//!
//! For tables that are looked up and never walked, so that no order depends on it. It does not resist keys that are chosen to
//! collide: names from files go through the standard one.

use std::hash::{BuildHasherDefault, Hasher};

/// For `HashMap::with_hasher` and the like.
pub(crate) type BuildMixer = BuildHasherDefault<Mixer>;

/// What has been mixed so far.
#[derive(Default)]
pub(crate) struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        let (numbers, rest) = bytes.as_chunks::<8>();
        numbers.iter().for_each(|number| self.write_u64(u64::from_le_bytes(*number)));
        rest.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u64(&mut self, number: u64) {
        // The upper bits of a product depend on all of the number; tables use the lower ones, too.
        let product = (self.0 ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = product ^ product >> 32;
    }
}
