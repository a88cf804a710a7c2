// Tape dispenser: weighted base, a wall on the rear side that carries the roll of tape on its hub, and a nose with the cutter.
// 150 x 60 x 80 mm. Cutter is +x, open side -y. Unit: mm.
use <prism.scad>

centre = [-22, 48];  // hub, (x, z)

module base() box([-70, -30, 0], [70, 30, 18]);

module wall() prism_along_y([[-70, 10], [52, 10], [52, 44], [0, 70], [-48, 70], [-70, 52]], 14, 30);

module roll() prism_along_y(octagon(centre, 32, 13), -14, 14);

module hub() prism_along_y([for (p = [[16, 0], [8, 14], [-8, 14], [-16, 0], [-8, -14], [8, -14]]) centre + p], -28, 0);

module nose() prism_along_y([[35, 10], [70, 10], [70, 32], [80, 42], [80, 52], [52, 44]], -30, 30);

union() {
  base();
  wall();
  roll();
  hub();
  nose();
}
