//! Tables and figures of Fan and Wonka 2016.

fn main() -> std::process::ExitCode {
    edifice_experiments::main(&edifice_experiments::building_exteriors::EXPERIMENT)
}
