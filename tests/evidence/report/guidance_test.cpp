// SPDX-License-Identifier: MIT
// Touching over the distance from guidance points: the file's grips by the core's contacts.
// sanitizers: address
#include "evidence/report/guidance.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/support/result_reader.h"
#include "tests/support/sweep_results.h"

namespace wholehand {
namespace {

std::string written_guidance(const SweptScene& swept, std::size_t vessel) {
  MarkupWriter html;
  write_guidance(html, *swept.source, vessel, "v");
  EXPECT_TRUE(html.is_closed());
  EXPECT_EQ(html.written().find("nan"), std::string::npos);
  return html.written();
}

TEST(GuidedGrips, AreTheFeasibleAndPlausibleOnes) {
  const SweptScene swept(RESULT_SCENE);
  const auto reasons = read_values(swept.path, "reason"), plausible = read_values(swept.path, "plausible"),
             touch = read_values(swept.path, "touch_mask"), used = read_values(swept.path, "fingers_used");
  for (std::size_t v = 0; v < 2; ++v) {
    const GuidedSample sample = guided_grips(*swept.source, v);
    EXPECT_EQ(sample.looked_at, swept.plan->stored_grips());
    EXPECT_FALSE(sample.is_by_core);
    std::size_t next = 0;
    for (std::uint64_t place = 0; place < swept.plan->stored_grips(); ++place) {
      const std::size_t at = v * swept.plan->stored_grips() + place;
      if (reasons[at] != 0 || plausible[at] != 1) continue;
      ASSERT_LT(next, sample.grips.size());
      const GuidedGrip& grip = sample.grips[next++];
      EXPECT_EQ(grip.touch_mask, static_cast<std::uint32_t>(touch[at]));
      EXPECT_EQ(grip.fingers, static_cast<int>(used[at]));
    }
    EXPECT_EQ(next, sample.grips.size());
    EXPECT_GT(next, 30u);
  }
}

TEST(GuidedGrips, OfRepeatedAzimuthsHaveTheirOwnDistances) {
  // level grips of a cylinder touch it at their height: at the points' azimuths the difference of heights is all
  const SweptScene swept(edited(edited(RESULT_SCENE, "obliquity_deg = [-10, 10]", "obliquity_deg = 0"), "[0, 60, 120]", "[0, 90]"));
  const auto reasons = read_values(swept.path, "reason"), plausible = read_values(swept.path, "plausible");
  const GuidedSample sample = guided_grips(*swept.source, 0);
  std::size_t next = 0;
  for (std::uint64_t place = 0; place < swept.plan->stored_grips(); ++place) {
    if (reasons[place] != 0 || plausible[place] != 1) continue;
    const GripInput grip = stored_grip(*swept.plan, swept.scene, 0, place);
    // index and thumb at azimuth 0 and 180, or both a quarter turn from either point
    const double up = grip.height - 0.055, low = grip.height - 0.035, chord = 0.035 * std::sqrt(2.0);
    const double wanted =
        grip.azimuth == 0 ? std::min(std::abs(up), std::abs(low)) : std::min(std::hypot(up, chord), std::hypot(low, chord));
    // m: the closure's stop tolerance and rounding
    EXPECT_NEAR(sample.grips.at(next++).distance, wanted, 1e-7) << grip.height << " " << grip.azimuth;
  }
  EXPECT_EQ(next, sample.grips.size());
}

TEST(GuidedGrips, WithoutMasksInTheFileAreTheCores) {
  const SweptScene whole(RESULT_SCENE), few(edited(RESULT_SCENE, "best = 5", "best = 5\nkeep = [\"score\"]"));
  const auto all = guided_grips(*whole.source, 0), other = guided_grips(*few.source, 0);
  EXPECT_TRUE(other.is_by_core);
  ASSERT_EQ(all.grips.size(), other.grips.size());
  for (std::size_t i = 0; i < all.grips.size(); ++i) {
    EXPECT_EQ(all.grips[i].distance, other.grips[i].distance);
    EXPECT_EQ(all.grips[i].touch_mask, other.grips[i].touch_mask);
    EXPECT_EQ(all.grips[i].fingers, other.grips[i].fingers);
  }
  EXPECT_NE(written_guidance(few, 0).find("lacks some of the points that touch"), std::string::npos);
}

TEST(ReportGuidance, HasARowForEachPointOfTheHand) {
  const SweptScene swept(RESULT_SCENE);
  const std::string html = written_guidance(swept, 0);
  for (const char* point : {"thumb CMC", "thumb tip", "index PIP", "little tip"})
    EXPECT_NE(html.find(std::string("<th scope=\"row\">") + point + "</th>"), std::string::npos) << point;
  std::size_t rows = 0;
  for (std::size_t at = html.find("scope=\"row\""); at != std::string::npos; at = html.find("scope=\"row\"", at + 1)) ++rows;
  EXPECT_EQ(rows, 24u);
  const GuidanceStatistics statistics = guidance_statistics(guided_grips(*swept.source, 0).grips);
  EXPECT_NE(html.find("n = " + std::to_string(statistics.grips)), std::string::npos);
  EXPECT_NE(html.find("r = " + shown_number(*statistics.fingers.r, 2)), std::string::npos);
  EXPECT_NE(html.find("55.0 mm, 0°; 35.0 mm, 180°"), std::string::npos);
}

TEST(ReportGuidance, WhereThereIsNothingToTellItIsSaid) {
  EXPECT_NE(written_guidance(SweptScene(edited(RESULT_SCENE, "guidance_mm = [[42, 90]]", "")), 1).find("no guidance points"),
            std::string::npos);
  EXPECT_NE(written_guidance(SweptScene(edited(RESULT_SCENE, "diameter_mm = 70", "diameter_mm = 300")), 0).find("nothing to count"),
            std::string::npos);
  SweptScene swept(RESULT_SCENE);
  swept.source->core = nullptr;
  swept.source->no_core = "no mesh";
  EXPECT_NE(written_guidance(swept, 0).find("This part is left out: no mesh."), std::string::npos);
}

TEST(ReportGuidance, OneGripHasNoCorrelation) {
  const SweptScene swept(edited(
      edited(edited(edited(RESULT_SCENE, "{ from = 0.1, to = 0.95, count = 12 }", "0.6"), "[-90, -30, 0]", "0"), "[-10, 10]", "0"),
      "[0, 60, 120]", "0"));
  const std::string html = written_guidance(swept, 0);
  EXPECT_NE(html.find("no correlation (fewer than three grips)"), std::string::npos) << html;
}

}  // namespace
}  // namespace wholehand
