//! Time of this thread alone, since machines are shared; Linux only.

/// Microseconds that this thread has run.
fn thread_us() -> f64 {
    // The kernel brings the counter up to date when a thread yields.
    std::thread::yield_now();
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    stat.split_whitespace().next().and_then(|nanoseconds| nanoseconds.parse::<f64>().ok()).unwrap_or(f64::NAN) * 1e-3
}

/// Runs go on for so long.
const ENOUGH_US: f64 = 30_000.0;
const FEWEST_RUNS: usize = 5;

/// The median of many runs, after some that warm up; freeing what is made is not timed.
pub fn median_us<T>(work: impl Fn() -> T) -> f64 {
    let run = || {
        let start = thread_us();
        let made = std::hint::black_box(work());
        let spent = thread_us() - start;
        drop(made);
        spent
    };
    run();
    run();
    let mut samples = Vec::new();
    while samples.len() < FEWEST_RUNS || samples.iter().sum::<f64>() < ENOUGH_US {
        samples.push(run());
    }
    samples.sort_by(f64::total_cmp);
    samples[samples.len() / 2]
}
