//! The `faultspace` command.

fn main() -> std::process::ExitCode {
    faultspace::cli::main()
}
