//! Tables and figures of Wu et al. 2014.

fn main() -> std::process::ExitCode {
    edifice_experiments::main(&edifice_experiments::facade_grammar::EXPERIMENT)
}
