// SPDX-License-Identifier: Apache-2.0
// Fields of a large cloud are read again: the same ones, or an error where the file is another.
#include "server/annotate/cloud_fields.hpp"

#include <gtest/gtest.h>

#include "support/temp_folder.hpp"

namespace saccade::test {
namespace {

using server::CloudFields;

class CloudFieldsTest : public testing::Test {
 protected:
  void write(std::span<const float> heights) {
    const std::vector<float> zeros(heights.size(), 0.0F);
    ColumnTable table;
    for (const char* name : {"x", "y", "z"}) table.add<float>(name, zeros);
    table.add<float>("height", heights);
    table.add<float>("twice", std::vector<float>(heights.begin(), heights.end()));
    ASSERT_TRUE(write_pcd(path_, table));
  }
  CloudFields fields(std::size_t most_kept_bytes) {
    auto file = read_cloud(path_);
    EXPECT_TRUE(file);
    return {path_, std::move(*file), most_kept_bytes};
  }

  TempFolder folder_;
  std::filesystem::path path_{folder_ / "cloud.pcd"};
};

TEST_F(CloudFieldsTest, AreTheSameReadAgain) {
  write(std::array{1.0F, 2.5F, -3.0F});
  const CloudFields kept = fields(CloudFields::kMostKept_bytes);
  const CloudFields read = fields(1);
  EXPECT_TRUE(kept.in_memory());
  EXPECT_FALSE(read.in_memory());
  EXPECT_EQ(kept.names(), (std::vector<std::string>{"height", "twice"}));
  EXPECT_EQ(read.names(), kept.names());
  const auto a = kept.file();
  const auto b = read.file();
  ASSERT_TRUE(a && b);
  EXPECT_EQ((*a)->fields(), (*b)->fields());
  for (const char* name : {"height", "twice", "height"}) {
    const auto numbers = read.numbers(name);
    ASSERT_TRUE(numbers);
    EXPECT_EQ(std::vector(numbers->begin(), numbers->end()), (std::vector{1.0F, 2.5F, -3.0F}));
  }
}

TEST_F(CloudFieldsTest, AreNotThoseOfAnotherFile) {
  write(std::array{1.0F, 2.5F, -3.0F});
  const CloudFields kept = fields(CloudFields::kMostKept_bytes);
  const CloudFields read = fields(1);
  write(std::array{1.0F, 2.5F});
  EXPECT_TRUE(kept.file());
  const auto changed = read.file();
  ASSERT_FALSE(changed);
  EXPECT_EQ(changed.error().code, Errc::corrupt_data);
  EXPECT_NE(changed.error().to_string().find("changed after it was opened"), std::string::npos);
  std::filesystem::remove(path_);
  EXPECT_EQ(read.numbers("height").error().code, Errc::not_found);
}

}  // namespace
}  // namespace saccade::test
