// Stick: a slender bar with a bevelled end, one long edge chamfered, and a cross-lap notch off its middle.
// 170 x 32 x 24 mm. Bevelled end is +x. Unit: mm.
use <prism.scad>

difference() {
  prism_along_y([[-85, 0], [85, 0], [85, 9], [70, 24], [-85, 24]], -16, 16);
  prism_along_x([[4, 26], [18, 12], [18, 26]], -90, 90);  // chamfer of the rear upper edge
  box([-45, -20, 12], [-13, 20, 30]);                     // notch
}
