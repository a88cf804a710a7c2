// Helpers shared by the objects: straight prisms from a polygon in a vertical plane.

// Polygon of (x, z) points, from y = front to y = back.
module prism_along_y(points, front, back) {
  translate([0, back, 0]) rotate([90, 0, 0]) linear_extrude(back - front) polygon(points);
}

// Polygon of (y, z) points, from x = left to x = right.
module prism_along_x(points, left, right) {
  translate([left, 0, 0]) rotate([90, 0, 90]) linear_extrude(right - left) polygon(points);
}

// Box between two opposite corners.
module box(low, high) {
  translate(low) cube(high - low);
}

// Eight corners around a centre; all coordinates stay whole numbers when the arguments are.
// `far` is half the distance of opposite sides, `near` half the length of the four axis-parallel sides.
function octagon(centre, far, near) = [
  for (p = [[far, -near], [far, near], [near, far], [-near, far],
            [-far, near], [-far, -near], [-near, -far], [near, -far]]) centre + p
];
