//! The one door to files: dialogs, reading, writing. In a browser it becomes a picker and downloads.
