// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/json_io.hpp"

#include <string>

#include "saccade/io/files/file_io.hpp"

namespace saccade {

std::string message_of(const nlohmann::json::exception& exception) {
  std::string what{exception.what()};  // "[json.exception.parse_error.101] parse error at …"
  if (const std::size_t tag = what.find("] "); tag != std::string::npos) what.erase(0, tag + 2);
  return what;
}

Result<nlohmann::json> parse_json(std::string_view text) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& e) {
    const auto* parse_error = dynamic_cast<const nlohmann::json::parse_error*>(&e);
    return Error{Errc::corrupt_data, "not valid JSON: " + message_of(e),
                 parse_error != nullptr ? "byte " + std::to_string(parse_error->byte) : std::string{}};
  }
}

Result<nlohmann::json> read_json(const std::filesystem::path& path) {
  SACCADE_TRY(const std::string text, read_text_file(path));
  return in_file(parse_json(text), path);
}

Status write_json(const std::filesystem::path& path, const nlohmann::json& value) {
  constexpr int kIndent{2};
  // Text that is no UTF-8 (a file name) must not throw.
  return write_file_atomically(path, value.dump(kIndent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

nlohmann::json pose_to_json(const Pose& T_a_b) {
  nlohmann::json rows = nlohmann::json::array();
  for (int i = 0; i < 4; ++i) {
    nlohmann::json row = nlohmann::json::array();
    for (int j = 0; j < 4; ++j) row.push_back(T_a_b.matrix()(i, j));
    rows.push_back(std::move(row));
  }
  return rows;
}

Result<Pose> pose_from_json(const nlohmann::json& value) {
  const Error shape{Errc::corrupt_data, "a pose must be a 4x4 nested array of numbers, row by row", {}};
  if (!value.is_array() || value.size() != 4) return shape;
  Eigen::Matrix4d matrix;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!value[i].is_array() || value[i].size() != 4) return shape;
    for (std::size_t j = 0; j < 4; ++j) {
      if (!value[i][j].is_number()) return shape;
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = value[i][j].get<double>();
    }
  }
  return pose_from_matrix(matrix);
}

}  // namespace saccade
