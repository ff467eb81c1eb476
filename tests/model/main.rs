//! Models and tables from files to files: every command of `edifice model`, and linfa beside our mixtures.

#[path = "../common/cases.rs"]
mod cases;
mod cells;
mod commands;
mod files;
mod fitted;
mod linfa;
mod relations;
mod tables;
