//! The files of an export to a folder: all of them checked first, each written whole or not at all, the scene last.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sr_render::output::{OutputError, write_then_rename};
use thiserror::Error;

use crate::OutputFile;

/// Why files were not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The scene is made from it.
    #[error("{} would be overwritten, and the scene is made from it: choose another name", path.display())]
    Input {
        /// The file.
        path: PathBuf,
    },
    /// Something is there.
    #[error("{} exists: choose another name, or allow to overwrite it", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The system refused.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The system refused a folder.
    #[error("cannot make the folder {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// Writes files into `folder`; their paths. `inputs` are never overwritten, others if `overwrite` allows it.
///
/// # Errors
/// See [`WriteError`]. What was written before an error stays: the scene itself, which is the last file, is not there then.
pub fn write_files(
    files: &[OutputFile],
    folder: &Path,
    inputs: &[PathBuf],
    overwrite: bool,
) -> Result<Vec<PathBuf>, WriteError> {
    let inputs: Vec<PathBuf> = inputs.iter().filter_map(|path| fs::canonicalize(path).ok()).collect();
    let paths: Vec<PathBuf> = files.iter().map(|file| folder.join(&file.name)).collect();
    for path in &paths {
        let Ok(there) = fs::canonicalize(path) else { continue };
        if inputs.contains(&there) {
            return Err(WriteError::Input { path: path.clone() });
        }
        if !overwrite {
            return Err(WriteError::Exists { path: path.clone() });
        }
    }
    for (file, path) in files.iter().zip(&paths) {
        if file.name.contains('/')
            && let Some(parent) = path.parent()
        {
            fs::create_dir_all(parent)
                .map_err(|source| WriteError::Folder { path: parent.to_owned(), source })?;
        }
        write_then_rename(path, |out| file.content.write_to(out))?;
    }
    Ok(paths)
}
