//! What can go wrong while a report is written.

use std::path::PathBuf;

/// Why a figure, table or page could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The file system refused.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// File or directory concerned.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The drawing library refused.
    #[error("cannot draw: {0}")]
    Draw(String),
    /// A point cloud cannot be written as VTK.
    #[error("cannot write points: {0}")]
    Points(#[from] vtkio::Error),
    /// A table cannot be written as CSV.
    #[error("cannot write a table: {0}")]
    Table(#[from] csv::Error),
    /// A result cannot be written as JSON.
    #[error("cannot write a result: {0}")]
    Json(#[from] serde_json::Error),
}
