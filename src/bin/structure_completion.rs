//! The benchmark and the figures of Fan et al. 2014.

fn main() -> std::process::ExitCode {
    edifice::experiments::main(&edifice::experiments::structure_completion::EXPERIMENT)
}
