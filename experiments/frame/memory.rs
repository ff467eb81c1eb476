//! Memory of this process, where the system tells.

/// Sets the peak of resident memory back to what is resident now, where the system can.
pub fn reset_peak() {
    // A system without this file reports the peak of the whole run, which is an upper bound.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Peak of resident memory in megabytes (10^6 bytes), where the system tells.
pub fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024.0 / 1e6)
}
