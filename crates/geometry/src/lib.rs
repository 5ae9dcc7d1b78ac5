//! Shapes, domains, regions and point clouds in one, two and three dimensions
