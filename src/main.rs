//! The `faultspace` command.

fn main() -> std::process::ExitCode {
    // candle looks up the number of cores before every product unless this names it, which takes
    // as long as the product; studies have thread pools of their own.
    // SAFETY: no other thread runs yet.
    unsafe { std::env::set_var("RAYON_NUM_THREADS", "1") };
    faultspace::cli::main()
}
