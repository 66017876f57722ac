//! The memory of this process.

/// Resident bytes of this process; `None` if the system does not provide them (Linux does).
pub fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    /// 64 MiB that are written to are in memory. Other tests run at the same time, so no more is said than that.
    #[test]
    fn what_is_written_to_is_resident() {
        let bytes = std::hint::black_box(vec![1_u8; 64 << 20]);
        assert!(super::resident().is_some_and(|resident| resident >= 64 << 20));
        drop(bytes);
    }
}
