//! Tables and figures of Fan and Wonka 2016.

fn main() -> std::process::ExitCode {
    edifice::experiments::main(&edifice::experiments::building_exteriors::EXPERIMENT)
}
