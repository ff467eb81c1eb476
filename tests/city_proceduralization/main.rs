//! Cities: grammars, files and commands.

mod box_textures;
#[path = "../common/cases.rs"]
mod cases;
mod cga;
#[path = "../common/cga_judge.rs"]
mod cga_judge;
mod citygml;
mod commands;
mod compact;
mod compressed_gltf;
mod country;
mod far_away;
mod formats;
mod gltf;
mod grammar;
mod interrupted;
mod invariance;
mod new_cities;
mod parametric;
mod photographs;
mod systems;
mod textures;
mod tiles;
mod town;
