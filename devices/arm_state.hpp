// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmState: the true joint positions of a simulated arm, in a file shared by the programs of one cell.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace saccade::devices {

/// One writer, any number of readers; a reader never sees a partial write.
class ArmState {
 public:
  explicit ArmState(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file < 0 || ::ftruncate(file, sizeof(Record)) != 0) throw std::runtime_error{"cannot open " + path};
    void* memory = ::mmap(nullptr, sizeof(Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    ::close(file);
    if (memory == MAP_FAILED) throw std::runtime_error{"cannot map " + path};
    record_ = static_cast<Record*>(memory);
  }
  ArmState(const ArmState&) = delete;
  ArmState& operator=(const ArmState&) = delete;
  ~ArmState() { ::munmap(record_, sizeof(Record)); }

  void write(const std::vector<double>& q) {
    record_->writes.fetch_add(1);  // odd: write in progress
    record_->joints.store(q.size());
    for (std::size_t i = 0; i < q.size(); ++i) record_->q[i].store(q[i]);
    record_->writes.fetch_add(1);
  }
  /// Returns the positions; empty before the first write.
  [[nodiscard]] std::vector<double> read() const {
    for (;;) {
      const std::size_t before = record_->writes.load();
      std::vector<double> q(record_->joints.load());
      for (std::size_t i = 0; i < q.size(); ++i) q[i] = record_->q[i].load();
      if (before % 2 == 0 && record_->writes.load() == before) return q;
    }
  }

 private:
  struct Record {
    std::atomic<std::size_t> writes;
    std::atomic<std::size_t> joints;
    std::array<std::atomic<double>, 16> q;
  };
  Record* record_{nullptr};
};

}  // namespace saccade::devices
