//! Looks of a building's finishes: colours, textures and how they reflect.

use edifice_shape::solid::Finish;

use crate::textures::Texture;

/// The look of a finish.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Colour from afar, sRGB.
    pub colour: [u8; 3],
    /// Pattern, if there is one.
    pub texture: Option<Texture>,
    /// From 0, a mirror, to 1, chalk.
    pub roughness: f32,
    /// Share of the light that passes through.
    pub transmission: f32,
}

impl Look {
    /// A look with a pattern, chalky, that no light passes through.
    pub fn textured(colour: [u8; 3], texture: Texture) -> Self {
        Self {
            colour,
            texture: Some(texture),
            roughness: 0.9,
            transmission: 0.0,
        }
    }
}

/// Looks of all finishes of a building.
#[derive(Debug, Clone, PartialEq)]
pub struct Palette {
    /// Of chimneys.
    pub chimney: Look,
    /// Of outer walls.
    pub wall: Look,
    /// Of sloped roofs.
    pub roof: Look,
    /// Of level roofs.
    pub flat_roof: Look,
    /// Of eaves, posts and beams.
    pub trim: Look,
    /// Of floors of porches.
    pub deck: Look,
    /// Of frames and sills.
    pub frame: Look,
    /// Of glass.
    pub pane: Look,
    /// Of leaves of doors.
    pub door: Look,
    /// Of leaves of garage doors.
    pub garage_door: Look,
}

impl Palette {
    /// The look of a finish, and the name of its material in files; `is_level` tells level roofs from sloped ones.
    pub fn look(&self, finish: Finish, is_level: bool) -> (&'static str, Look) {
        match finish {
            Finish::Chimney => ("chimney", self.chimney),
            Finish::Wall => ("wall", self.wall),
            Finish::Roof if is_level => ("flat_roof", self.flat_roof),
            Finish::Roof => ("roof", self.roof),
            Finish::Trim => ("trim", self.trim),
            Finish::Deck => ("deck", self.deck),
            Finish::Frame => ("frame", self.frame),
            Finish::Pane => ("pane", self.pane),
            Finish::Door => ("door", self.door),
            Finish::GarageDoor => ("garage_door", self.garage_door),
        }
    }

    /// All looks, to change what they have in common.
    pub fn looks_mut(&mut self) -> [&mut Look; 10] {
        [
            &mut self.chimney,
            &mut self.wall,
            &mut self.roof,
            &mut self.flat_roof,
            &mut self.trim,
            &mut self.deck,
            &mut self.frame,
            &mut self.pane,
            &mut self.door,
            &mut self.garage_door,
        ]
    }
}
