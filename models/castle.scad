// Castle: a square tower with a merlon on each corner. Near twin of the holed cube: the outer box is the same.
// 80 x 80 x 80 mm, merlons 26 x 26 x 22 mm. Unit: mm.
use <prism.scad>

difference() {
  box([-40, -40, 0], [40, 40, 80]);
  box([-14, -50, 58], [14, 50, 90]);
  box([-50, -14, 58], [50, 14, 90]);
}
