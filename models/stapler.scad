// Stapler: long base, and above a gap the arm (magazine below, wider cover above), hinged at the rear and rising to the front.
// 150 x 44 x 71 mm. Front is +x. Unit: mm.
use <prism.scad>

module base() prism_along_y([[-75, 0], [75, 0], [60, 14], [-75, 14]], -22, 22);

// The hinge block and the magazine are one piece.
module magazine() prism_along_y([[-64, 10], [-40, 10], [-40, 22], [70, 44], [70, 60], [-64, 33]], -12, 12);

module cover() prism_along_y([[-70, 28], [75, 57], [75, 66], [55, 71], [-60, 48], [-70, 37]], -19, 19);

union() {
  base();
  magazine();
  cover();
}
