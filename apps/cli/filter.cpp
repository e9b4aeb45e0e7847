// SPDX-License-Identifier: Apache-2.0
// saccade filter: removes the shadow and veil points of a Kinect v2 from depth images, and shows which.
#include <algorithm>
#include <array>

#include "context.hpp"
#include "filter.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/frames/depth_io.hpp"
#include "saccade/report/depth_picture.hpp"
#include "saccade/sensor/mask.hpp"
#include "server/report_file.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kReportFileName{"report.html"};
constexpr std::string_view kPictureFolder{"pictures"};

/// Filtered frames are PNG files, whatever they were before.
fs::path result_name(const fs::path& file) { return file.filename().replace_extension(".png"); }

/// Filtered frames keep their names: so no two may have the same one, and none may stand in the folder of the results.
Status check_names(const std::vector<InputFrame>& frames, const fs::path& out) {
  std::vector<fs::path> names;
  std::error_code ignored;
  for (const InputFrame& frame : frames) {
    const fs::path folder = frame.file.has_parent_path() ? frame.file.parent_path() : fs::path{"."};
    const fs::path name = result_name(frame.file);
    for (const fs::path& results : {out, out / kPictureFolder}) {
      if (!fs::equivalent(folder, results, ignored) && !fs::equivalent(frame.file, results / name, ignored)) continue;
      return Error{Errc::invalid_argument, "the results would replace the frames; name another folder with --out",
                   out.string()};
    }
    names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return {};
  return Error{Errc::invalid_argument, "two of the frames have this name; filter them into two folders",
               twice->string()};
}

/// The camera of a frame: with --intrinsics and without a preset, its size is the image's.
PinholeCamera camera_of(const FilterOptions& options, const InputFrame& input, const Image16& samples) {
  PinholeCamera camera = input.camera ? options.camera_options.camera(*input.camera) : options.camera;
  if (options.camera_options.intrinsics && !options.camera_options.preset) {
    camera.width = samples.width();
    camera.height = samples.height();
  }
  return camera;
}

struct DepthFrame {
  Image16 samples;
  DepthImage depth;
  PinholeCamera camera;
};

/// Samples of 16 bits: those of a PNG as they are; the depths of other formats by the encoding.
Result<Image16> read_samples(const fs::path& file, const FilterOptions& options) {
  if (file.extension() == ".png") return read_png16(file);
  const UnitsSource source = options.depth_scale ? UnitsSource::given : UnitsSource::layout;
  SACCADE_TRY(const DepthImage depth, read_depth_image(file, {options.encoding, source}));
  return encode_depth(depth, options.encoding);
}

Result<DepthFrame> read_frame(const InputFrame& input, const FilterOptions& options) {
  const fs::path& file = input.file;
  SACCADE_TRY(Image16 samples, read_samples(file, options));
  DepthFrame frame{std::move(samples), {}, {}};
  frame.camera = camera_of(options, input, frame.samples);
  if (frame.samples.width() != frame.camera.width || frame.samples.height() != frame.camera.height) {
    return Error{Errc::size_mismatch,
                 "has " + std::to_string(frame.samples.width()) + "x" + std::to_string(frame.samples.height()) +
                     " pixels, the camera " + std::to_string(frame.camera.width) + "x" +
                     std::to_string(frame.camera.height) + "; pass --camera or --intrinsics",
                 file.string()};
  }
  frame.depth = decode_depth(frame.samples, options.encoding);
  return frame;
}

/// Points outside the camera's range are none any more, in both; they were there to throw shadows.
/// @return how many.
std::size_t remove_out_of_range(DepthFrame& frame, FilteredDepth& filtered) {
  clip_to_range(frame.camera, frame.depth);
  std::size_t removed{0};
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    FilteredPixel& pixel = filtered.pixels.data()[i];
    if (frame.depth.data()[i] > 0.0F || pixel == FilteredPixel::no_return) continue;
    filtered.points -= 1;
    filtered.shadow_points -= pixel == FilteredPixel::shadow_point ? 1 : 0;
    filtered.veil_points -= pixel == FilteredPixel::veil_point ? 1 : 0;
    filtered.depth.data()[i] = 0.0F;
    pixel = FilteredPixel::no_return;
    ++removed;
  }
  return removed;
}

/// Samples that stay are those of the file, bit for bit; saturated ones are no points and stay.
Image16 kept_samples(const DepthFrame& frame, const FilteredDepth& filtered) {
  constexpr std::uint16_t kSaturated{65535};
  Image16 kept = frame.samples;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const bool stays = filtered.pixels.pixels()[i] == FilteredPixel::kept || kept.data()[i] == kSaturated;
    if (!stays) kept.data()[i] = 0;
  }
  return kept;
}

Status write_picture(const RunFolder& out, const fs::path& name, const DepthFrame& frame,
                     const FilteredDepth& filtered) {
  const fs::path folder = out / kPictureFolder;
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Error{Errc::io_failure, "cannot make the folder: " + code.message(), folder.string()};
  return write_png(folder / name, filter_picture(frame.depth, filtered, name.string()));
}

Result<FilteredFrame> filter_frame(const InputFrame& input, const FilterOptions& options, const RunFolder& out,
                                   const Executor& executor, bool with_picture) {
  const fs::path& file = input.file;
  SACCADE_TRY(DepthFrame frame, read_frame(input, options));
  auto filter = DepthFilter::create(frame.camera, options.filter);
  if (!filter) return in_file(filter.error(), file);
  const Stopwatch watch;
  SACCADE_TRY(FilteredDepth filtered, filter->filter(frame.depth, executor));
  const double ms = watch.elapsed_ms();
  const std::size_t out_of_range = remove_out_of_range(frame, filtered);
  const fs::path name = result_name(file);
  SACCADE_CHECK(write_png16(out.path() / name, kept_samples(frame, filtered)));
  if (with_picture) SACCADE_CHECK(write_picture(out, name, frame, filtered));
  return FilteredFrame{file, filtered.points, filtered.shadow_points, filtered.veil_points, out_of_range, ms};
}

/// A failed write ends the work; a file of a folder that cannot be used is left out.
bool is_left_out(const InputFrame& frame, const Error& error) {
  return frame.from_folder && error.code != Errc::io_failure;
}

/// Adds to the result what was done, also where it fails.
Status filter_all(const std::vector<InputFrame>& frames, const FilterOptions& options, const RunFolder& out,
                  const Executor& executor, ProgressBar& bar, FilterResult& result) {
  for (std::size_t i = 0; i < frames.size() && !interrupted(); ++i) {
    bar.update("filtering", i, frames.size());
    const bool with_picture = options.write_pictures && result.frames.size() < options.pictures;
    auto filtered = filter_frame(frames[i], options, out, executor, with_picture);
    if (filtered) {
      result.frames.push_back(std::move(*filtered));
    } else if (is_left_out(frames[i], filtered.error())) {
      if (filtered.error().code == Errc::unsupported) ++result.other_kinds;  // such as the colours beside the depth
      result.left_out.push_back({frames[i].file, filtered.error()});
    } else {
      return filtered.error();
    }
  }
  return {};
}

/// Samples per metre are those of the folders, unless an option gives them.
Result<DepthEncoding> common_encoding(const std::vector<InputFrame>& frames, const FilterOptions& options) {
  if (options.depth_scale || frames.empty()) return options.encoding;
  const DepthEncoding first = frames.front().encoding.value_or(options.encoding);
  for (const InputFrame& frame : frames) {
    if (frame.encoding.value_or(options.encoding) == first) continue;
    return Error{Errc::invalid_argument,
                 "its depth samples have another scale than those of the frames before; filter them into two folders",
                 frame.file.string()};
  }
  return first;
}

/// Removes the files of an earlier run from the folder, as its filter.json lists them.
Status remove_earlier_frames(const RunFolder& out) {
  constexpr std::uintmax_t kMostBytes{std::uintmax_t{256} << 20U};
  std::vector<std::string> names{std::string{kFilterFile}, std::string{kReportFileName}};
  const auto add = [&names](const nlohmann::json& frame) {
    if (!frame.is_string()) return;
    const fs::path name = result_name(frame.get<std::string>());
    names.insert(names.end(), {name, fs::path{kPictureFolder} / name});
  };
  const auto text = read_text_file(out / kFilterFile, kMostBytes);
  const nlohmann::json earlier = nlohmann::json::parse(text ? *text : "", nullptr, false);
  const nlohmann::json::json_pointer details{"/result/details"};
  if (earlier.is_object() && earlier.contains(details)) {
    for (const nlohmann::json& frame : earlier.at(details)) {
      if (frame.is_object()) add(frame.value("frame", nlohmann::json{}));
    }
  }
  const nlohmann::json::json_pointer planned{"/result/planned"};
  if (earlier.is_object() && earlier.contains(planned)) {
    for (const nlohmann::json& frame : earlier.at(planned)) add(frame);
  }
  return out.remove(std::vector<std::string_view>{names.begin(), names.end()});
}

/// Files that were left out, by their reason: each reason once, with the number of its files and the first of them.
std::vector<std::string> reasons_of(const std::vector<LeftOutFile>& left_out) {
  std::vector<std::pair<std::string, std::size_t>> reasons;
  std::vector<std::string> firsts;
  for (const LeftOutFile& each : left_out) {
    const Error& error = each.error;
    if (error.code == Errc::unsupported) continue;
    const auto same = [&error](const auto& reason) { return reason.first == error.message; };
    const auto found = std::find_if(reasons.begin(), reasons.end(), same);
    if (found != reasons.end()) {
      ++found->second;
    } else {
      reasons.emplace_back(error.message, 1);
      firsts.push_back(error.context);
    }
  }
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    const std::size_t more = reasons[i].second - 1;
    texts.push_back(firsts[i] + (more > 0 ? " and " + std::to_string(more) + " more" : "") + ": " + reasons[i].first);
  }
  return texts;
}

/// Why there is not a single frame. Depth images that do not fit the camera say more than pictures of another kind.
Error nothing_filtered(const FilterResult& result) {
  if (interrupted()) return {Errc::cancelled, "interrupted", {}};
  const auto is_depth = [](const LeftOutFile& left_out) { return left_out.error.code != Errc::unsupported; };
  const auto depth = std::find_if(result.left_out.begin(), result.left_out.end(), is_depth);
  const Error& first = depth == result.left_out.end() ? result.left_out.front().error : depth->error;
  const std::vector<std::string> reasons = reasons_of(result.left_out);
  const std::string why = reasons.empty() ? first.to_string() : joined(reasons, "; ");
  return {first.code,
          "not one of the " + std::to_string(result.left_out.size()) + " depth images can be filtered: " + why +
              ". filter is for the depth images of a Kinect v2 and of sensors like it",
          {}};
}

/// Leaves a folder that holds nothing but the document of this run as if it had not been there. Where other files of an
/// earlier run lie, the document stays, so that the next run knows the folder.
Status leave_no_document(const RunFolder& out) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator{out.path(), ignored}) {
    if (entry.path().filename() != kFilterFile) return {};
  }
  return out.remove(std::array{kFilterFile});
}

/// A failure, with what was done before it.
Error failure_after(Error error, const FilterResult& result, const std::string& folder) {
  const std::size_t frames = result.frames.size();
  if (frames == 0) return error;
  error.message += "; what was filtered before it (" + std::to_string(frames) + (frames == 1 ? " frame" : " frames") +
                   ") is in " + folder + ", and the same command may be run again";
  return error;
}

PinholeCamera first_camera(const std::vector<InputFrame>& frames, const FilterOptions& options) {
  const bool has_own = !frames.empty() && frames.front().camera;
  return has_own ? options.camera_options.camera(*frames.front().camera) : options.camera;
}

/// Says that the frames are not a Kinect v2's, by their size, and are filtered with its emitter; empty otherwise.
std::string sensor_note(const std::vector<InputFrame>& frames, const FilterOptions& options) {
  const PinholeCamera camera = first_camera(frames, options);
  const PinholeCamera kinect = camera_preset("kinect-v2").value();
  const bool is_kinect = camera.width == kinect.width && camera.height == kinect.height;
  if (is_kinect || options.filter.baseline_m != DepthFilterConfig{}.baseline_m) return {};
  const auto size_of = [](const PinholeCamera& of) {
    return std::to_string(of.width) + "x" + std::to_string(of.height);
  };
  return "the camera has " + size_of(camera) + " pixels, a Kinect v2 " + size_of(kinect) +
         ": the filter is for a Kinect v2, with its emitter 8 cm beside the camera, and removes good points of other "
         "sensors; see --baseline, --emitter and --only";
}

/// Warns, once for all frames, of a camera that is valid but strange.
std::string camera_warning(const std::vector<InputFrame>& frames, const FilterOptions& options) {
  const PinholeCamera camera = first_camera(frames, options);
  const std::string doubt = Intrinsics::doubt(camera);
  return doubt.empty() ? doubt : "warning: " + doubt;
}

class Filter final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"filter", "removes a Kinect v2's shadow and veil points from depth images"};
  }
  void declare(Options& options) override { declare_filter(options, filter_); }
  void check(const GlobalOptions& /*global*/) override { check_filter_options(filter_); }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    SACCADE_TRY(const FilterInput input, filter_input(filter_));
    const std::vector<InputFrame>& frames = input.frames;
    SACCADE_CHECK(check_names(frames, context.out()));
    SACCADE_TRY(filter_.encoding, common_encoding(frames, filter_));
    SACCADE_CHECK(context.open_folder());
    const RunFolder& out = *context.folder();
    for (const std::string& note : input.notes) context.bar().note(note);
    if (const std::string note = sensor_note(frames, filter_); !note.empty()) context.bar().note(note);
    FilterResult result;
    SACCADE_CHECK(begin(context, frames, result));
    const Status filtered = filter_all(frames, filter_, out, context.executor(), context.bar(), result);
    const std::string folder = context.out().string();
    if (!filtered || result.frames.empty()) {
      if (result.frames.empty()) SACCADE_CHECK(leave_no_document(out));
      return filtered ? nothing_filtered(result) : failure_after(filtered.error(), result, folder);
    }
    for (const std::string& reason : reasons_of(result.left_out)) context.bar().note("left out: " + reason);
    Outcome outcome{.result = filter_json(filter_, folder, result, interrupted())};
    SACCADE_CHECK(server::write_report(out / kReportFileName, context.document(outcome.result)));
    if (result.points() > 0) {
      outcome.text = filter_text(folder, result);
      for (const std::string& warning : {camera_warning(frames, filter_), filter_range_warning(result)}) {
        if (!warning.empty()) outcome.warnings.push_back(warning);
      }
    }
    if (interrupted()) {
      outcome.cut_short = "interrupted after " + std::to_string(result.frames.size()) + " of " +
                          std::to_string(frames.size()) + " frames; they are in " + folder;
    }
    return std::move(outcome).empty_if(
        result.points() == 0,
        "no frame has a point within the camera's range: see --min-range, --max-range and --depth-scale");
  }

 private:
  /// Writes the document of a run that is not complete, by which a later run knows the folder and what lies in it.
  [[nodiscard]] Status begin(const Context& context, const std::vector<InputFrame>& frames,
                             FilterResult& result) const {
    const RunFolder& out = *context.folder();
    SACCADE_CHECK(remove_earlier_frames(out));
    for (const InputFrame& frame : frames) result.planned.push_back(frame.file);
    return write_json(out / kFilterFile,
                      context.document_so_far(filter_json(filter_, context.out().string(), result, false)));
  }

  FilterOptions filter_;
};

}  // namespace

void add_filter(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Filter>(program, global, action);
}

}  // namespace saccade::cli
