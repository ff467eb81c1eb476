//! Tables and figures of Demir, Aliaga and Benes 2014.

fn main() -> std::process::ExitCode {
    edifice::experiments::main(&edifice::experiments::city_proceduralization::EXPERIMENT)
}
