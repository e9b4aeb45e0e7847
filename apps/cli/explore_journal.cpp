// SPDX-License-Identifier: Apache-2.0
#include "explore_journal.hpp"

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "saccade/io/clouds/surfel_array.hpp"
#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/io/runs/run_json.hpp"

namespace saccade::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::string_view kFile{"journal.json"};
constexpr std::string_view kSchema{"saccade-exploration/1"};

bool is_checkpoint(const std::string& name) {
  return name.starts_with("checkpoint-") && (name.ends_with(".sacmap") || name.ends_with(".npy"));
}

/// Returns a checksum of all entries but the checksum itself, so that a journal that was changed is found out.
std::uint64_t checksum_of(json document) {
  document.erase("crc32");
  const std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  return crc32(as_byte_span(text));
}

/// Removes the maps and surfels of a journal but for those of this name.
Status remove_checkpoints(const fs::path& folder, const std::string& but) {
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator{folder, code}) {
    const std::string name = entry.path().filename().string();
    if (!is_checkpoint(name) || entry.path().stem() == but) continue;
    fs::remove(entry.path(), code);
    if (code) return Error{Errc::io_failure, "cannot be removed: " + code.message(), entry.path().string()};
  }
  return {};
}

/// The file under a second name, at no cost where the file system can.
Status name_too(const fs::path& file, const fs::path& name) {
  std::error_code code;
  fs::remove(name, code);
  fs::create_hard_link(file, name, code);
  if (code) fs::copy_file(file, name, code);
  return code ? Status{Error{Errc::io_failure, "cannot be written: " + code.message(), name.string()}} : Status{};
}

/// Writes the surfels. Returns their name and checksum.
Result<json> save_surfels(const SurfelMap& surfels, const fs::path& folder, const std::string& name) {
  const std::vector<std::byte> bytes = encode_surfels(surfels);
  SACCADE_TRY(AtomicFile file, AtomicFile::create(folder / name));
  SACCADE_CHECK(file.write(bytes));
  SACCADE_CHECK(file.commit());
  return json{{"file", name}, {"crc32", crc32(bytes)}};
}

Result<SurfelMap> load_surfels(const fs::path& folder, const json& saved) {
  const fs::path path = folder / saved.at("file").get<std::string>();
  SACCADE_TRY(const std::vector<std::byte> bytes, read_file(path));
  if (crc32(bytes) != saved.at("crc32"))
    return Error{Errc::corrupt_data, "the surfels are damaged: their checksum is another", path.string()};
  return in_file(decode_surfels(bytes), path);
}

Result<ExploreJournal> journal_from(const json& document) {
  ExploreJournal journal;
  journal.settings = document.at("settings");
  journal.scanned = !document.at("initial").is_null();
  // A scan under way has a key of its own, which journals of old do not have.
  const json& scan = journal.scanned ? document.at("initial") : document.value("scanning", json(nullptr));
  if (!scan.is_null()) {
    SACCADE_TRY(journal.run.scan, scan_from_json(scan));
  }
  SACCADE_TRY(journal.run.views, views_from_json(document.at("views")));
  SACCADE_TRY(journal.q, configuration_from_json(document.value("arm", json(nullptr))));
  const auto frames = document.at("frames").get<std::size_t>();
  if (frames < journal.frames()) return Error{Errc::corrupt_data, "views have more frames than the run", ""};
  journal.run.scan.frames = frames - journal.frames();
  return journal;
}

}  // namespace

std::size_t ExploreJournal::frames() const {
  std::size_t frames = run.scan.frames;
  for (const ViewRecord& view : run.views) frames += view.frames + view.frames_on_way;
  return frames;
}

Status ExploreJournal::save(const fs::path& folder, const TsdfSnapshot& map, const SurfelMap* surfels,
                            const Executor& executor, const std::string& keep_as) const {
  const std::size_t number = scanned ? run.views.size() : run.scan.attempted;
  const std::string name = (scanned ? "checkpoint-" : "checkpoint-scan-") + std::to_string(number);
  const std::string checkpoint = name + ".sacmap";
  SACCADE_CHECK(save_map(map, folder / checkpoint, executor));
  json kept(nullptr);
  if (surfels != nullptr) {
    SACCADE_TRY(kept, save_surfels(*surfels, folder, name + ".npy"));
  }
  if (!keep_as.empty()) SACCADE_CHECK(name_too(folder / checkpoint, folder / keep_as));
  json document{{"schema", kSchema},
                {"settings", settings},
                {"map", checkpoint},
                {"surfels", kept},
                {"frames", frames()},
                {"initial", scanned ? scan_to_json(run.scan) : json(nullptr)},
                {"scanning", scanned ? json(nullptr) : scan_to_json(run.scan)},
                {"views", views_to_json(run.views)},
                {"arm", configuration_to_json(q)}};
  document["crc32"] = checksum_of(document);
  SACCADE_CHECK(write_json(folder / kFile, document));
  return remove_checkpoints(folder, name);
}

bool has_journal(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / kFile, ignored);
}

Result<SavedExploration> load_journal(const fs::path& folder, const Executor& executor) {
  if (!has_journal(folder)) {
    return Error{Errc::not_found, "there is no interrupted run here to go on with", folder.string()};
  }
  SACCADE_TRY(const json document, read_json(folder / kFile));
  try {
    if (document.at("schema") != kSchema) {
      return Error{Errc::unsupported, "the journal is of another version; start anew with --force", folder.string()};
    }
    if (document.at("crc32") != checksum_of(document)) throw std::runtime_error{"its checksum is another"};
    const auto checkpoint = document.at("map").get<std::string>();
    auto journal = journal_from(document);
    if (!journal) throw std::runtime_error{journal.error().message};
    SACCADE_TRY(TsdfSnapshot map, load_map(folder / checkpoint, executor));
    SavedExploration saved{std::move(*journal), std::move(map)};
    // Journals of old do not have the key.
    if (const json surfels = document.value("surfels", json(nullptr)); !surfels.is_null()) {
      SACCADE_TRY(saved.surfels, load_surfels(folder, surfels));
    }
    return saved;
  } catch (const std::exception& e) {
    return Error{Errc::corrupt_data, std::string{"the journal is damaged ("} + e.what() + "); start anew with --force",
                 (folder / kFile).string()};
  }
}

Status remove_journal(const fs::path& folder) {
  std::error_code code;
  fs::remove(folder / kFile, code);
  if (code) return Error{Errc::io_failure, "cannot be removed: " + code.message(), (folder / kFile).string()};
  return remove_checkpoints(folder, "");
}

}  // namespace saccade::cli
