#pragma once

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "run/files/provenance.h"

/// The little of HDF5's C interface that Shaken uses, with owners and exceptions. The exceptions do not leave
/// run/files.
namespace shaken::run::hdf5 {

/// A refused call: what was tried, and HDF5's innermost reason ("No space left on device").
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Call before anything else. HDF5 prints every refused call to stderr unless told not to; and at the end of the
/// program it closes what is open once more, which crashes (1.10.8) where a full disk kept a file from being closed.
void initialize();

/// Throws a Failure about `doing` if an HDF5 call returned a negative value.
template <class Value>
Value check(Value value, const std::string& doing);

/// Owns an identifier of any kind.
class Id {
 public:
  using Closer = herr_t (*)(hid_t);
  Id() = default;
  Id(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), closer_(other.closer_) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  ~Id() {
    if (id_ >= 0) closer_(id_);
  }
  operator hid_t() const { return id_; }
  /// Closes now, and throws if that fails: what HDF5 still held may be written only here.
  void close(const std::string& doing);

 private:
  hid_t id_ = -1;
  Closer closer_ = nullptr;
};

using Shape = std::vector<hsize_t>;

Id create_file(const std::filesystem::path& file);
/// Without HDF5's lock, which would keep readers out while a writer is at work.
Id open_file(const std::filesystem::path& file, bool writable);

Id create_group(hid_t where, const std::string& name);
Id open_group(hid_t where, const std::string& name);
bool exists(hid_t where, const std::string& name);

/// A data set of fixed size with its values; `type` is that of the values in memory and in the file.
void write_dataset(hid_t where, const std::string& name, hid_t type, const Shape& shape, const void* values);
/// An empty data set that grows along its first axis: `row` is the shape of one row. Compressed chunks carry a
/// checksum.
Id create_growing(hid_t where, const std::string& name, hid_t type, const Shape& row, hsize_t rows_per_chunk,
                  bool compress);
Id open_dataset(hid_t where, const std::string& name);
Shape shape(hid_t dataset);

void append_row(hid_t dataset, hid_t type, const void* values);
void read_row(hid_t dataset, hid_t type, hsize_t row, void* values);
/// A whole one-dimensional data set, or its first `n` values.
template <class T>
std::vector<T> read_vector(hid_t dataset, hid_t type);

void write_attribute(hid_t where, const std::string& name, const std::string& value);
void write_attribute(hid_t where, const std::string& name, const std::vector<std::string>& values);
/// A text of any length, which Python's h5py reads as str and MDAnalysis as a unit; it takes a text of fixed length,
/// which H5MD asks for, for bytes.
void write_free_text_attribute(hid_t where, const std::string& name, const std::string& value);
/// The attribute `unit` of a data set, as H5MD's module "units" writes it: "mm s-1"; "1" where there is none.
void write_unit(hid_t dataset, const std::string& unit);
void write_attribute(hid_t where, const std::string& name, hid_t type, const Shape& shape, const void* values);
bool has_attribute(hid_t where, const std::string& name);
void read_attribute(hid_t where, const std::string& name, hid_t type, void* value);
/// A string of fixed length, as write_attribute makes it.
std::string read_text_attribute(hid_t where, const std::string& name);

/// Nothing if there is no run.
void write_provenance(hid_t file, const Provenance& provenance);
/// Empty where the file carries none.
Provenance read_provenance(hid_t file);

void write_string(hid_t where, const std::string& name, const std::string& value);
std::string read_string(hid_t where, const std::string& name);

// ---

[[noreturn]] void fail(const std::string& doing);

template <class Value>
Value check(Value value, const std::string& doing) {
  if (value < 0) fail(doing);
  return value;
}

template <class T>
std::vector<T> read_vector(hid_t dataset, hid_t type) {
  const Shape extent = shape(dataset);
  if (extent.size() != 1)
    throw Failure("a data set that should have one dimension has " + std::to_string(extent.size()));
  std::vector<T> values(extent[0]);
  if (!values.empty()) check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read a data set");
  return values;
}

}  // namespace shaken::run::hdf5
