// SPDX-License-Identifier: MIT
// What one rank puts, another takes; a packet that is cut is no answer.
#include "sweeps/cluster/packet.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace wholehand::sweeps {
namespace {

TEST(Packet, GivesBackWhatWasPut) {
  PacketWriter writer;
  writer.put(7);
  writer.put(std::vector<double>{0.1, std::numeric_limits<double>::infinity()});
  writer.put(std::string("two\0words", 9));
  writer.put(std::vector<int>{});
  writer.put(true);
  PacketReader reader(writer.bytes());
  EXPECT_EQ(reader.take<int>(), 7);
  EXPECT_EQ(reader.take_all<double>(), (std::vector<double>{0.1, std::numeric_limits<double>::infinity()}));
  EXPECT_EQ(reader.take_text(), std::string("two\0words", 9));
  EXPECT_TRUE(reader.take_all<int>().empty());
  EXPECT_TRUE(reader.take<bool>());
  EXPECT_THROW(reader.take<char>(), std::runtime_error);
}

TEST(Packet, RefusesOneThatIsCut) {
  PacketWriter writer;
  writer.put(std::vector<double>{1, 2, 3});
  for (std::size_t size = 0; size < writer.bytes().size(); ++size) {
    const std::string cut = writer.bytes().substr(0, size);
    EXPECT_THROW(PacketReader(cut).take_all<double>(), std::runtime_error) << size;
  }
}

}  // namespace
}  // namespace wholehand::sweeps
