// SPDX-License-Identifier: Apache-2.0
#include "raw_type.hpp"

#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <vector>

namespace saccade::ros2 {
namespace {

/// Message. Cyclone DDS counts references to it, and sees only its first member.
struct RawMessage {
  ddsi_serdata common;
  std::vector<std::byte> bytes;  ///< with the header; padded to a multiple of 4
  std::size_t size;              ///< without that padding
};

const RawMessage& raw(const ddsi_serdata* message) { return *reinterpret_cast<const RawMessage*>(message); }

RawMessage* new_message(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size) {
  auto* message = new RawMessage{{}, std::vector<std::byte>((size + 3) / 4 * 4), size};
  ddsi_serdata_init(&message->common, type, kind);
  message->common.hash = type->serdata_basehash;  // there are no keys: all messages are of one instance
  return message;
}

// Functions that Cyclone DDS needs of a message.

uint32_t size_of(const ddsi_serdata* message) { return static_cast<uint32_t>(raw(message).size); }

bool equal_keys(const ddsi_serdata* /*a*/, const ddsi_serdata* /*b*/) { return true; }

/// Assembles a message from packets.
ddsi_serdata* from_packets(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                           std::size_t size) {
  RawMessage* message = new_message(type, kind, size);
  std::size_t done = 0;
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end <= done) continue;
    const auto* payload =
        reinterpret_cast<const std::byte*>(NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment)));
    std::copy(payload + (done - fragment->min), payload + (end - fragment->min),
              message->bytes.begin() + static_cast<std::ptrdiff_t>(done));
    done = end;
  }
  return &message->common;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                          const ddsrt_iovec_t* pieces, std::size_t size) {
  RawMessage* message = new_message(type, kind, size);
  std::size_t done = 0;
  for (ddsrt_msg_iovlen_t i = 0; i < count && done < size; ++i) {
    const std::size_t bytes = std::min<std::size_t>(pieces[i].iov_len, size - done);
    std::memcpy(message->bytes.data() + done, pieces[i].iov_base, bytes);
    done += bytes;
  }
  return &message->common;
}

ddsi_serdata* from_key(const ddsi_sertype* type, const ddsi_keyhash* /*key*/) {
  return &new_message(type, SDK_KEY, 4)->common;
}

/// Makes a message from a sample, which is a span of bytes.
ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  const auto bytes = kind == SDK_DATA ? *static_cast<const std::span<const std::byte>*>(sample)  //
                                      : std::span<const std::byte>{};
  RawMessage* message = new_message(type, kind, std::max<std::size_t>(bytes.size(), 4));
  std::copy(bytes.begin(), bytes.end(), message->bytes.begin());
  return &message->common;
}

void to_bytes(const ddsi_serdata* message, std::size_t offset, std::size_t size, void* buffer) {
  std::memcpy(buffer, raw(message).bytes.data() + offset, size);
}

ddsi_serdata* lend_bytes(const ddsi_serdata* message, std::size_t offset, std::size_t size, ddsrt_iovec_t* piece) {
  piece->iov_base = const_cast<std::byte*>(raw(message).bytes.data() + offset);
  piece->iov_len = static_cast<ddsrt_iov_len_t>(size);
  return ddsi_serdata_ref(message);
}

void return_bytes(ddsi_serdata* message, const ddsrt_iovec_t* /*piece*/) { ddsi_serdata_unref(message); }

/// Messages are taken as they are, never as samples.
bool to_sample(const ddsi_serdata* /*message*/, void* /*sample*/, void** /*buffer*/, void* /*end*/) { return false; }
bool key_to_sample(const ddsi_sertype* /*type*/, const ddsi_serdata* /*message*/, void* /*sample*/, void** /*buffer*/,
                   void* /*end*/) {
  return true;  // asked about instances: there are no keys, so nothing is to be filled in
}

ddsi_serdata* to_key(const ddsi_serdata* message) {
  RawMessage* key = new_message(message->type, SDK_KEY, 4);
  key->common.type = nullptr;
  return &key->common;
}

void free_message(ddsi_serdata* message) { delete reinterpret_cast<RawMessage*>(message); }

std::size_t print(const ddsi_sertype* type, const ddsi_serdata* message, char* text, std::size_t size) {
  const int length = std::snprintf(text, size, "%s of %zu bytes", type->type_name, raw(message).size);
  return std::min(static_cast<std::size_t>(std::max(length, 0)), size - 1);
}

void key_hash(const ddsi_serdata* /*message*/, ddsi_keyhash* hash, bool /*force_md5*/) {
  std::memset(hash, 0, sizeof *hash);
}

const ddsi_serdata_ops& message_operations() {
  static const ddsi_serdata_ops operations = [] {
    ddsi_serdata_ops ops{};
    ops.eqkey = equal_keys;
    ops.get_size = size_of;
    ops.from_ser = from_packets;
    ops.from_ser_iov = from_pieces;
    ops.from_keyhash = from_key;
    ops.from_sample = from_sample;
    ops.to_ser = to_bytes;
    ops.to_ser_ref = lend_bytes;
    ops.to_ser_unref = return_bytes;
    ops.to_sample = to_sample;
    ops.to_untyped = to_key;
    ops.untyped_to_sample = key_to_sample;
    ops.free = free_message;
    ops.print = print;
    ops.get_keyhash = key_hash;
    return ops;
  }();
  return operations;
}

// Functions that it needs of a type.

void free_type(ddsi_sertype* type) {
  ddsi_sertype_fini(type);
  delete type;
}

const ddsi_sertype_ops& type_operations() {
  static const ddsi_sertype_ops operations = [] {
    ddsi_sertype_ops ops{};
    ops.version = ddsi_sertype_v0;
    ops.free = free_type;
    ops.zero_samples = [](const ddsi_sertype* /*type*/, void* /*samples*/, std::size_t /*count*/) {};
    ops.realloc_samples = [](void** samples, const ddsi_sertype* /*type*/, void* /*old*/, std::size_t /*had*/,
                             std::size_t count) { std::fill_n(samples, count, nullptr); };
    ops.free_samples = [](const ddsi_sertype* /*type*/, void** /*samples*/, std::size_t /*count*/,
                          dds_free_op_t /*what*/) {};
    ops.equal = [](const ddsi_sertype* /*a*/, const ddsi_sertype* /*b*/) { return true; };  // their names are compared
    ops.hash = [](const ddsi_sertype* /*type*/) { return uint32_t{0}; };
    ops.derive_sertype = [](const ddsi_sertype* type, dds_data_representation_id_t /*representation*/,
                            dds_type_consistency_enforcement_qospolicy_t /*consistency*/) {
      return const_cast<ddsi_sertype*>(type);  // XCDR1 and nothing else
    };
    return ops;
  }();
  return operations;
}

}  // namespace

ddsi_sertype* new_raw_type(const std::string& dds_name) {
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init_flags(type, dds_name.c_str(), &type_operations(), &message_operations(),
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

ddsi_serdata* raw_message(const ddsi_sertype* type, std::span<const std::byte> cdr) {
  return from_sample(type, SDK_DATA, &cdr);
}

std::span<const std::byte> bytes_of(const ddsi_serdata* message) {
  return std::span{raw(message).bytes}.first(raw(message).size);
}

}  // namespace saccade::ros2
