//! Figures of Weissenberg et al. 2013.

fn main() -> std::process::ExitCode {
    edifice::experiments::main(&edifice::experiments::procedural_logic::EXPERIMENT)
}
