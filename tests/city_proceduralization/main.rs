//! Cities: grammars, files and commands.

mod commands;
mod gltf;
mod grammar;
