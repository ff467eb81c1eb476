//! Tables and figures of Demir, Aliaga and Benes 2014.

fn main() -> std::process::ExitCode {
    edifice_experiments::main(&edifice_experiments::city_proceduralization::EXPERIMENT)
}
