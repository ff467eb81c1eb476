//! The benchmark and the figures of Fan et al. 2014.

fn main() -> std::process::ExitCode {
    edifice_experiments::main(&edifice_experiments::structure_completion::EXPERIMENT)
}
