// Pencil box: the lid is slid open and leaves a step; beside it two compartments, one wide and deep, one narrow.
// In the lid a grip recess; one corner is cut off.
// 170 x 70 x 44 mm. Open end is +x. Unit: mm.
use <prism.scad>

module body() prism_along_y([[-85, 0], [85, 0], [85, 32], [25, 32], [15, 44], [-85, 44]], -35, 35);

difference() {
  body();
  box([33, -27, 10], [77, 3, 40]);      // wide compartment
  box([33, 11, 18], [77, 27, 40]);      // narrow compartment
  box([-55, -20, 35], [-10, 12, 50]);   // grip recess
  translate([-85, 35, -1]) linear_extrude(50) polygon([[-1, -18], [18, 1], [-1, 1]]);  // cut corner
}
