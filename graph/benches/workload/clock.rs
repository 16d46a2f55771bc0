//! Time of this thread alone, since machines are shared; Linux only.

/// Microseconds that this thread has run.
fn thread_us() -> f64 {
    // The kernel brings the counter up to date when a thread yields.
    std::thread::yield_now();
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    stat.split_whitespace().next().and_then(|nanoseconds| nanoseconds.parse::<f64>().ok()).unwrap_or(f64::NAN) * 1e-3
}

/// The runs of each go on for so long.
const ENOUGH_US: f64 = 30_000.0;
const FEWEST_RUNS: usize = 5;

/// Microseconds that some work takes; freeing what it makes is not timed.
pub fn timed<T>(work: impl Fn() -> T) -> f64 {
    let start = thread_us();
    let made = std::hint::black_box(work());
    let spent = thread_us() - start;
    drop(made);
    spent
}

/// The median of many runs of each, after some that warm up. They take turns, so that a machine that slows down slows all.
pub fn medians<const COUNT: usize>(runs: [&dyn Fn() -> f64; COUNT]) -> [f64; COUNT] {
    runs.iter().for_each(|run| _ = (run(), run()));
    let mut samples: [Vec<f64>; COUNT] = std::array::from_fn(|_| Vec::new());
    while samples.iter().any(|samples| samples.len() < FEWEST_RUNS || samples.iter().sum::<f64>() < ENOUGH_US) {
        runs.iter().zip(&mut samples).for_each(|(run, samples)| samples.push(run()));
    }
    samples.map(|mut samples| {
        samples.sort_by(f64::total_cmp);
        samples[samples.len() / 2]
    })
}
