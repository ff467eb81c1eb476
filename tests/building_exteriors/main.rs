//! Houses: attributes, learning, generation, design, files and commands.

#[path = "../common/cases.rs"]
mod cases;

mod again;
mod attributes;
mod bays;
mod broken;
mod coding;
mod commands;
mod contradictions;
mod design;
mod dress;
mod errors;
mod from_facades;
mod from_facades_command;
mod fuzz;
mod generation;
mod gltf;
mod ifc;
mod io;
mod parts;
mod possible;
mod shipped;
mod survey;
