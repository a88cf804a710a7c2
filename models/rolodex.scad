// Rolodex: wedge-shaped base, two side plates, between them the drum of cards opened at one place, and a knob on the right.
// 138 x 112 x 96 mm. Front is -y. Unit: mm.
use <prism.scad>

centre = [5, 54];  // axle, (y, z)

module base() prism_along_x([[-56, 0], [56, 0], [56, 25], [-56, 11]], -60, 60);

module plate(left, right) prism_along_x([[-48, 6], [56, 6], [56, 41], [25, 72], [-18, 72], [-48, 12]], left, right);

module drum() difference() {
  prism_along_x(octagon(centre, 42, 17), -48, 48);
  prism_along_x([[1, 79], [5, 111], [-31, 111]], -50, 50);  // cards opened
}

module knob() prism_along_x([for (p = [[16, 0], [8, 14], [-8, 14], [-16, 0], [-8, -14], [8, -14]]) centre + p], 50, 78);

union() {
  base();
  plate(-60, -48);
  plate(48, 60);
  drum();
  knob();
}
