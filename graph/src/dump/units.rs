//! Sizes for people.

/// Bytes in the largest binary unit that leaves at least one: `12.5 MiB`, `256 B`. Whole numbers have no point.
pub(crate) fn bytes(bytes: u64) -> String {
    const UNITS: [&str; 6] = ["KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    if bytes < 1024 {
        return format!("{bytes} B");
    }
    let mut value = bytes as f64 / 1024.0;
    let mut units = UNITS.iter();
    let mut unit = units.next();
    while value >= 1024.0 {
        let Some(next) = units.next() else { break };
        value /= 1024.0;
        unit = Some(next);
    }
    let shown = format!("{value:.2}");
    format!("{} {}", shown.trim_end_matches('0').trim_end_matches('.'), unit.copied().unwrap_or("B"))
}
