//! Local Voronoi cells of scattered points, clipped to a domain, in one, two and three dimensions
