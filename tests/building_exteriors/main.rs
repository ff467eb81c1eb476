//! Houses: attributes, learning, generation, design, files and commands.

mod attributes;
mod broken;
mod coding;
mod commands;
mod contradictions;
mod design;
mod errors;
mod fuzz;
mod generation;
mod gltf;
mod io;
mod parts;
mod possible;
mod shipped;
mod survey;
