//! Tables and figures of Wu et al. 2014.

fn main() -> std::process::ExitCode {
    edifice::experiments::main(&edifice::experiments::facade_grammar::EXPERIMENT)
}
