// SPDX-License-Identifier: Apache-2.0
#include "server/report_file.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "saccade/io/files/file_io.hpp"
#include "server/web_page.hpp"

namespace saccade::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kStyleLink{R"(<link rel="stylesheet" href="assets/report.css">)"};
constexpr std::string_view kScriptLink{R"(<script src="assets/report.js"></script>)"};
constexpr std::string_view kRecordBegin{R"(<script type="application/json" id="record">)"};

/// Expects a file of the page.
std::string_view page_text(std::string_view path) {
  const auto files = page_files();
  const auto found =
      std::find_if(files.begin(), files.end(), [path](const PageFile& file) { return file.path == path; });
  SACCADE_EXPECTS(found != files.end());
  return {reinterpret_cast<const char*>(found->content.data()), found->content.size()};
}

/// Expects that the text has `what`.
void replace(std::string& text, std::string_view what, const std::string& by) {
  const std::size_t at = text.find(what);
  SACCADE_EXPECTS(at != std::string::npos);
  text.replace(at, what.size(), by);
}

/// Escapes "<" as JSON does, so that the text cannot end its element or begin a comment.
std::string in_element(const json& document) {
  std::string escaped;
  for (const char c : document.dump(-1, ' ', false, json::error_handler_t::replace)) {
    c == '<' ? escaped.append("\\u003c") : escaped.append(1, c);
  }
  return escaped;
}

void add_files(const fs::path& folder, const std::string& prefix, std::vector<std::string>& names) {
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder, code}) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') || name.ends_with(".html")) continue;
    if (entry.is_regular_file(code)) names.push_back(prefix + name);
    const bool holds_pictures = name == "pictures" || name.starts_with("task-");
    if (prefix.empty() && holds_pictures && entry.is_directory(code)) {
      add_files(entry.path(), name + '/', names);
    }
  }
}

}  // namespace

std::vector<std::string> report_files(const fs::path& folder) {
  std::vector<std::string> names;
  add_files(folder.empty() ? fs::path{"."} : folder, "", names);
  std::sort(names.begin(), names.end());
  return names;
}

json report_document(json record, const fs::path& folder, json details) {
  return {{"schema", "saccade-report/1"},
          {"record", std::move(record)},
          {"files", report_files(folder)},
          {"details", std::move(details)}};
}

std::string report_html(const json& document) {
  std::string page{page_text("report.html")};
  replace(page, kStyleLink, "<style>" + std::string{page_text("assets/report.css")} + "</style>");
  replace(page, kScriptLink, "<script>" + std::string{page_text("assets/report.js")} + "</script>");
  replace(page, kRecordBegin, std::string{kRecordBegin} + in_element(document));
  return page;
}

Status write_report(const fs::path& file, json record, json details) {
  return write_file_atomically(file,
                               report_html(report_document(std::move(record), file.parent_path(), std::move(details))));
}

}  // namespace saccade::server
