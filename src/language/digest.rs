//! The FNV-1a hash of a sequence of bytes.

/// FNV-1a, 64 bits (Fowler, Noll, Vo 1991).
pub fn of_bytes(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes
        .into_iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
