// Holed cube: a cube with a square hole through it from front to back. Near twin of the castle: the outer box is the same.
// 80 x 80 x 80 mm, hole 40 x 40 mm. Unit: mm.
use <prism.scad>

difference() {
  box([-40, -40, 0], [40, 40, 80]);
  box([-20, -50, 20], [20, 50, 60]);
}
