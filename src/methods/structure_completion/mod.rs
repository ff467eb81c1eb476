//! Structure completion (Fan, Musialski, Liu, Wonka 2014, *Structure Completion for Facade Layouts*).

pub mod completion;
pub mod layout;
pub mod measure;
pub mod partial;
pub mod task;
