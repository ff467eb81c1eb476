//! Figures of Weissenberg et al. 2013.

fn main() -> std::process::ExitCode {
    edifice_experiments::main(&edifice_experiments::procedural_logic::EXPERIMENT)
}
