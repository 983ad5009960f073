//! Processor time of this process: what other programs take of the machine doesn't count.

/// Seconds of processor time so far, summed over threads.
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
pub fn processor_seconds() -> f64 {
    #[repr(C)]
    struct Timespec {
        seconds: i64,
        nanoseconds: i64,
    }
    unsafe extern "C" {
        fn clock_gettime(clock: i32, time: *mut Timespec) -> i32;
    }
    const CLOCK_PROCESS_CPUTIME_ID: i32 = 2;
    let mut time = Timespec { seconds: 0, nanoseconds: 0 };
    // SAFETY: on 64-bit Linux the C library has this function, and `time` is a valid struct timespec.
    unsafe { clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &raw mut time) };
    time.seconds as f64 + time.nanoseconds as f64 * 1e-9
}

/// Seconds on the wall, times the threads that were asked for: right on a machine that does nothing else.
#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
pub fn processor_seconds() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64() * rayon::current_num_threads() as f64
}
