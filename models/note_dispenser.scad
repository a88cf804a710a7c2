// Note dispenser: a box with sloped front; in the slope a tray for a 76 mm note pad, open to the front,
// and on the flat top a pen groove, open to the right.
// 110 x 120 x 64 mm. Front is -y. Unit: mm.
use <prism.scad>

module body() prism_along_x([[-60, 0], [60, 0], [60, 64], [28, 64], [-60, 24]], -55, 55);

// Floor parallel to the slope, rear wall at right angles to it.
module tray() prism_along_x([[22, 48], [-66, 8], [-76, 30], [12, 70]], -43, 35);

module pen_groove() box([-33, 37, 50], [60, 51, 70]);

difference() {
  body();
  tray();
  pen_groove();
}
