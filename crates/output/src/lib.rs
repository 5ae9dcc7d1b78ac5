//! Pictures and files of scattered fields: SVG contours and charts, VTK
