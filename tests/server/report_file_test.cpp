// SPDX-License-Identifier: Apache-2.0
#include "server/report_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "saccade/io/files/file_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kBegin{R"(<script type="application/json" id="record">)"};
constexpr std::string_view kEnd{"</script>"};

/// The document that a browser would read from the page: up to the first end of the element.
json document_in(const std::string& page) {
  const std::size_t begin = page.find(kBegin);
  if (begin == std::string::npos) return nullptr;
  const std::size_t first = begin + kBegin.size();
  return json::parse(page.substr(first, page.find(kEnd, first) - first));
}

std::size_t count_of(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

json record_of(const std::string& scene) {
  return {{"schema", "saccade-result/1"}, {"command", "explore"}, {"result", {{"scene", scene}}}};
}

TEST(ReportFile, HoldsTheRecordAndNothingFromElsewhere) {
  const json document = server::report_document(record_of("table-1"), "/nowhere", {{"speed", 1.5}});
  const std::string page = server::report_html(document);
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
  EXPECT_NE(page.find("</html>"), std::string::npos);
  EXPECT_EQ(document_in(page), document);
  EXPECT_EQ(document["schema"], "saccade-report/1");
  EXPECT_EQ(document["details"]["speed"], 1.5);
  EXPECT_EQ(page.find("assets/report"), std::string::npos) << "styles and script are inside";
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_GT(page.size(), 100'000U);
  EXPECT_LT(page.size(), 400'000U) << "kept small, as every run has one";
}

TEST(ReportFile, HostileNamesCannotEndTheRecord) {
  const std::string plain = server::report_html(server::report_document(record_of("plain"), "/nowhere"));
  const std::string hostile = "</script><script>alert(1)</script><!-- \" ' & \u2028 ]]>";
  const json document = server::report_document(record_of(hostile), "/nowhere");
  const std::string page = server::report_html(document);
  EXPECT_EQ(document_in(page)["record"]["result"]["scene"], hostile);
  EXPECT_EQ(count_of(page, kEnd), count_of(plain, kEnd));
  EXPECT_EQ(count_of(page, "<!--"), count_of(plain, "<!--"));
  const std::string no_utf8 = server::report_html(server::report_document(record_of("a\xFFz"), "/nowhere"));
  EXPECT_EQ(document_in(no_utf8)["record"]["result"]["scene"], "a\uFFFDz");
}

TEST(ReportFile, ListsPicturesBesideItAndThoseOfTasks) {
  const test::TempFolder folder;
  fs::create_directories(folder.path() / "task-1");
  fs::create_directories(folder.path() / "other");
  fs::create_directories(folder.path() / "pictures");
  for (const char* name :
       {"view-01-map.png", "a<b>.png", ".hidden", "report.html", "task-1/hand.png", "other/x.png", "pictures/y.png"}) {
    std::ofstream{folder.path() / name} << "x";
  }
  EXPECT_EQ(server::report_files(folder.path()),
            (std::vector<std::string>{"a<b>.png", "pictures/y.png", "task-1/hand.png", "view-01-map.png"}));
  EXPECT_TRUE(server::report_files(folder.path() / "none").empty());
}

TEST(ReportFile, IsWrittenBesideThePictures) {
  const test::TempFolder folder;
  std::ofstream{folder.path() / "view-00-map.png"} << "x";
  ASSERT_TRUE(server::write_report(folder.path() / "report.html", record_of("table-1")).ok());
  const std::string page = read_text_file(folder.path() / "report.html", 1U << 20U).value();
  EXPECT_EQ(document_in(page)["files"], json::array({"view-00-map.png"}));
  EXPECT_EQ(server::write_report(folder.path() / "none" / "report.html", record_of("x")).error().code,
            Errc::io_failure);
}

}  // namespace
}  // namespace saccade
