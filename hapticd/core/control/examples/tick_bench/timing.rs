//! Times of many ticks, told by quantiles of several repeats.

use std::time::Instant;

const REPEATS: usize = 3;
const TICKS: u64 = 200_000;
/// Fewer for a world that takes its time.
const FEW_TICKS: u64 = 20_000;
/// Ticks before the first one timed.
const WARM_UP: u64 = 2_000;
const QUANTILES: [(&str, f64); 3] = [("median", 0.5), ("p99", 0.99), ("p99.9", 0.999)];

/// What came of one tick.
pub struct Tick {
    pub time_ns: u64,
    pub touching: bool,
}

/// How it is measured.
pub fn preamble() -> String {
    format!(
        "{REPEATS} repeats of {TICKS} ticks, each in a fresh world; min / median of the repeats, ns; \
         reading the clock is {} ns of each",
        clock_ns()
    )
}

/// Times a world that `fresh` makes for each repeat: called with the number of a tick, it carries
/// that out. Leaves out those that do not have the first argument of the program in their name.
pub fn report<W: FnMut(u64) -> Tick>(name: &str, mut fresh: impl FnMut() -> W) {
    if std::env::args()
        .nth(1)
        .is_some_and(|only| !name.contains(&only))
    {
        return;
    }
    let ticks = if name.ends_with("close") {
        FEW_TICKS
    } else {
        TICKS
    };
    let mut touching = 0;
    let repeats: Vec<[u64; 3]> = (0..REPEATS)
        .map(|_| {
            let mut world = fresh();
            for tick in 0..WARM_UP {
                world(tick);
            }
            touching = 0;
            let mut times_ns: Vec<u64> = (WARM_UP..WARM_UP + ticks)
                .map(|tick| {
                    let done = world(tick);
                    touching += u64::from(done.touching);
                    done.time_ns
                })
                .collect();
            times_ns.sort_unstable();
            QUANTILES.map(|(_, share)| times_ns[((ticks - 1) as f64 * share) as usize])
        })
        .collect();
    print!("{name:<34}");
    for (i, (quantile, _)) in QUANTILES.iter().enumerate() {
        let mut over: Vec<u64> = repeats.iter().map(|repeat| repeat[i]).collect();
        over.sort_unstable();
        print!("  {quantile} {:>6}/{:<6}", over[0], over[REPEATS / 2]);
    }
    println!("  touching {:>3} %", 100 * touching / ticks);
}

/// Carries out `work` and times it.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, u64) {
    let start = Instant::now();
    let done = std::hint::black_box(work());
    (done, start.elapsed().as_nanos() as u64)
}

/// Median cost of reading the clock, which every figure includes, ns.
fn clock_ns() -> u64 {
    let mut times_ns: Vec<u64> = (0..10_000).map(|_| timed(|| ()).1).collect();
    times_ns.sort_unstable();
    times_ns[times_ns.len() / 2]
}
