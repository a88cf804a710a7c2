#include "compiler/golden_scan.h"

#include <gtest/gtest.h>

#include "tests/runtime/compiled_objects.h"

namespace foresight {
namespace {

using test::compiled_objects;

CompiledModel stick() { return compiled_objects().models()[1]; }

TEST(ChooseGoldenScan, gives_what_was_compiled_and_the_same_again) {
  for (std::size_t i = 0; i < 2; ++i) {
    const CompiledModel& model = compiled_objects().models()[i];
    const std::optional<GoldenScan> chosen =
        choose_golden_scan(test::castle_and_stick()[i], model, compiled_objects().content());
    ASSERT_TRUE(chosen);
    EXPECT_EQ(chosen->depths, model.golden_scan->depths);
    EXPECT_EQ(chosen->T_sensor_model.rotation, model.golden_scan->T_sensor_model.rotation);
  }
}

TEST(ChooseGoldenScan, takes_a_compact_scan_that_shows_several_faces) {
  const SensorModel& sensor = compiled_objects().content().sensor;
  for (const CompiledModel& model : compiled_objects().models()) {
    EXPECT_LT(model.golden_scan->depths.size(), 20U * 1024U);
    const RangeImage image = decode_golden_scan(*model.golden_scan, sensor.camera);
    EXPECT_GE(extract_regions(image, sensor.camera, compiled_objects().content().segmentation).size(), 3U);
  }
}

TEST(ChooseGoldenScan, gives_none_where_nothing_is_recognized) {
  CompiledModel changed = stick();
  changed.acceptance.bias = -1000.0;
  EXPECT_FALSE(choose_golden_scan(test::castle_and_stick()[1], changed, compiled_objects().content()));
  EXPECT_FALSE(choose_golden_scan(test::castle_and_stick()[1], stick(), compiled_objects().content(), {0.9, 0}));
}

}  // namespace
}  // namespace foresight
