// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/process_messages.hpp"

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "saccade/io/files/json_io.hpp"
#include "saccade/io/files/little_endian.hpp"
#include "saccade/io/files/text_scan.hpp"
#include "saccade/io/frames/camera_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/sensor/mask.hpp"

namespace saccade {
namespace {

constexpr std::size_t kQuotedLineBytes{80};
constexpr std::size_t kReasonBytes{300};

Error bad(std::string what) { return {Errc::corrupt_data, std::move(what), {}}; }

std::string moving_request(const char* request, std::size_t number, const Pose& T_world_camera) {
  return nlohmann::json{{"request", request}, {"number", number}, {"T_world_camera", pose_to_json(T_world_camera)}}
      .dump();
}

Status expect_count(const nlohmann::json& answer, const char* key, std::size_t expected, Errc otherwise) {
  const auto value = answer.find(key);
  if (value == answer.end()) return bad(std::string{"the key "} + key + " is missing");
  if (!value->is_number_unsigned()) return bad(std::string{key} + " must be an integer that is not negative");
  if (value->get<std::uint64_t>() == expected) return {};
  return Error{otherwise, std::string{key} + " must be " + std::to_string(expected) + ", not " + value->dump(), {}};
}

Status expect_protocol(const nlohmann::json& answer) {
  const Status same = expect_count(answer, "saccade", kProcessProtocol, Errc::unsupported);
  if (same.ok() || same.error().code != Errc::unsupported) return same;
  return Error{Errc::unsupported, "it speaks another version of the protocol: " + same.error().message, {}};
}

/// Returns the pose in an answer, if there is one.
/// @param T_world_camera the expected pose
Result<std::optional<Pose>> optional_pose(const nlohmann::json& answer, const Pose& T_world_camera) {
  const auto value = answer.find("T_world_camera");
  if (value == answer.end()) return std::optional<Pose>{};
  auto pose = pose_from_json(*value);
  if (!pose) return Error{pose.error().code, "T_world_camera: " + pose.error().message, {}};
  const double off_m = (pose->translation() - T_world_camera.translation()).norm();
  if (off_m > kMaxPoseError_m) {
    std::ostringstream text;
    text << "T_world_camera is " << off_m << " m from the pose that was asked for; at most " << kMaxPoseError_m
         << " m can be right: check its units (metres) and its frame";
    return bad(text.str());
  }
  return std::optional<Pose>{*pose};
}

/// Returns the value named by the text under a key.
template <class T, std::size_t N>
Result<T> expect_one_of(const nlohmann::json& answer, const char* key, const Names<T, N>& names) {
  const auto value = answer.find(key);
  const auto* text = value == answer.end() ? nullptr : value->get_ptr<const std::string*>();
  const auto found = text == nullptr ? std::nullopt : names.find(*text);
  return found ? Result<T>{*found} : bad(std::string{key} + " must be \"" + joined(names.words, "\" or \"") + "\"");
}

Result<PinholeCamera> hello_camera(const nlohmann::json& answer, std::string_view line) {
  for (const char* key : {"width", "height", "fx", "fy", "cx", "cy", "min_range_m", "max_range_m"}) {
    if (!answer.contains(key)) return bad(std::string{"the key "} + key + " is missing");
  }
  if (answer.contains("distortion")) {
    return Error{Errc::unsupported, "its images must be undistorted; distortion is not read here", {}};
  }
  SACCADE_TRY(const Intrinsics intrinsics, parse_intrinsics(line));
  return intrinsics.camera(intrinsics.width.value_or(0), intrinsics.height.value_or(0));
}

}  // namespace

Result<nlohmann::json> parse_answer(std::string_view line) {
  auto answer = parse_json(line);
  if (!answer) return bad("it is not JSON: '" + readable(line, kQuotedLineBytes) + "'; messages belong on stderr");
  if (!answer->is_object()) return bad("it is not a JSON object: '" + readable(line, kQuotedLineBytes) + "'");
  if (const auto error = answer->find("error"); error != answer->end()) {
    const auto* text = error->get_ptr<const std::string*>();
    if (text == nullptr) return bad("error must be a text");
    return Error{Errc::unavailable, readable(*text, kReasonBytes), {}};
  }
  return answer;
}

std::size_t ProgramCameraFormat::frame_bytes() const {
  const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  return pixels * ((depth == ProgramDepth::float32_m ? sizeof(float) : sizeof(std::uint16_t)) +
                   (color == ProgramColor::rgb8 ? sizeof(Rgb8) : 0));
}

std::string hello_request(std::string_view role) {
  return nlohmann::json{{"saccade", kProcessProtocol}, {"request", "hello"}, {"role", role}}.dump();
}

std::string capture_request(std::size_t number, const Pose& T_world_camera) {
  return moving_request("capture", number, T_world_camera);
}

std::string move_request(std::size_t number, const Pose& T_world_camera) {
  return moving_request("move", number, T_world_camera);
}

Result<ProgramCameraFormat> parse_camera_hello(std::string_view line) {
  SACCADE_TRY(const nlohmann::json answer, parse_answer(line));
  SACCADE_CHECK(expect_protocol(answer));
  ProgramCameraFormat format;
  SACCADE_TRY(format.camera, hello_camera(answer, line));
  SACCADE_TRY(format.depth, expect_one_of(answer, "depth", kProgramDepthNames));
  SACCADE_TRY(format.color, expect_one_of(answer, "color", kProgramColorNames));
  if (format.frame_bytes() > kMaxFrameBytes) {
    return bad("a frame of " + std::to_string(format.frame_bytes()) + " bytes is more than the " +
               std::to_string(kMaxFrameBytes) + " read here");
  }
  return format;
}

Result<Ready> parse_ready(std::string_view line) {
  SACCADE_TRY(const nlohmann::json answer, parse_answer(line));
  SACCADE_CHECK(expect_protocol(answer));
  return Ready{};
}

Result<CaptureAnswer> parse_capture_answer(std::string_view line, std::size_t number, std::size_t frame_bytes,
                                           const Pose& T_world_camera) {
  SACCADE_TRY(const nlohmann::json answer, parse_answer(line));
  SACCADE_CHECK(expect_count(answer, "number", number, Errc::corrupt_data));
  SACCADE_CHECK(expect_count(answer, "bytes", frame_bytes, Errc::size_mismatch));
  CaptureAnswer capture;
  SACCADE_TRY(capture.T_world_camera, optional_pose(answer, T_world_camera));
  if (const auto time = answer.find("time_s"); time != answer.end()) {
    if (!time->is_number()) return bad("time_s must be a number");
    capture.time_s = time->get<double>();
  }
  return capture;
}

Result<MoveAnswer> parse_move_answer(std::string_view line, std::size_t number, const Pose& T_world_camera) {
  SACCADE_TRY(const nlohmann::json answer, parse_answer(line));
  SACCADE_CHECK(expect_count(answer, "number", number, Errc::corrupt_data));
  const auto reached = answer.find("reached");
  if (reached == answer.end() || !reached->is_boolean()) return bad("reached must be true or false");
  MoveAnswer move;
  if (const auto why = answer.find("why"); why != answer.end()) {
    const auto* text = why->get_ptr<const std::string*>();
    if (text == nullptr) return bad("why must be a text");
    move.why = readable(*text, kReasonBytes);
  }
  if (!reached->get<bool>()) return move;
  SACCADE_TRY(const std::optional<Pose> measured, optional_pose(answer, T_world_camera));
  move.T_world_camera = measured.value_or(T_world_camera);
  return move;
}

Frame decode_frame(const ProgramCameraFormat& format, std::span<const std::byte> bytes) {
  SACCADE_EXPECTS(bytes.size() == format.frame_bytes());
  const int width = format.camera.width;
  const int height = format.camera.height;
  ByteReader reader{bytes};
  Frame frame;
  if (format.depth == ProgramDepth::float32_m) {
    frame.depth = DepthImage{width, height};
    const auto samples = reader.take(frame.depth.size() * sizeof(float));
    std::memcpy(frame.depth.data(), samples.data(), samples.size());
  } else {
    Image16 samples{width, height};
    const auto stored = reader.take(samples.size() * sizeof(std::uint16_t));
    std::memcpy(samples.data(), stored.data(), stored.size());
    frame.depth = decode_depth(samples, DepthEncoding{});
  }
  clip_to_range(format.camera, frame.depth);
  if (format.color == ProgramColor::rgb8) {
    frame.color = ColorImage{width, height};
    std::memcpy(frame.color->data(), reader.take(reader.left()).data(), frame.color->size() * sizeof(Rgb8));
  }
  return frame;
}

}  // namespace saccade
