#include "run/files/hdf5.h"

#include <algorithm>
#include <string_view>

#include "run/files/version.h"

namespace shaken::run::hdf5 {
namespace {

herr_t keep_innermost(unsigned, const H5E_error2_t* error, void* reason) {
  *static_cast<std::string*>(reason) = error->desc;
  return 0;
}

/// Access properties of files that others may read while they grow.
Id unlocked_access() {
  Id access(check(H5Pcreate(H5P_FILE_ACCESS), "prepare file access"), H5Pclose);
  check(H5Pset_file_locking(access, false, true), "switch file locking off");
  return access;
}

Id text_type(bool variable, std::size_t length) {
  Id type(check(H5Tcopy(H5T_C_S1), "make a string type"), H5Tclose);
  check(H5Tset_size(type, variable ? H5T_VARIABLE : std::max<std::size_t>(length, 1)), "size a string type");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "set a string type to UTF-8");
  return type;
}

Id scalar_space() { return {check(H5Screate(H5S_SCALAR), "make a scalar space"), H5Sclose}; }

Id simple_space(const Shape& extent) {
  return {check(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), "make a data space"),
          H5Sclose};
}

void put_attribute(hid_t where, const std::string& name, hid_t type, hid_t space, const void* values) {
  const Id attribute(check(H5Acreate2(where, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), "create " + name),
                     H5Aclose);
  check(H5Awrite(attribute, type, values), "write " + name);
}

/// Selects one row; returns the spaces in the file and in memory.
std::pair<Id, Id> row_spaces(hid_t dataset, hsize_t row) {
  Id file_space(check(H5Dget_space(dataset), "look at a data set"), H5Sclose);
  Shape count = shape(dataset);
  Shape start(count.size(), 0);
  start[0] = row;
  count[0] = 1;
  check(H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), "select a row");
  return {std::move(file_space), simple_space(count)};
}

}  // namespace

void initialize() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

void fail(const std::string& doing) {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_innermost, &reason);  // ends at the innermost call
  // of a refused write it tells time, addresses and sizes on two lines; what the system said stands in quotes
  constexpr std::string_view kSaid = "error message = '";
  if (const std::size_t said = reason.find(kSaid); said != std::string::npos) {
    const std::size_t begin = said + kSaid.size();
    reason = reason.substr(begin, reason.find('\'', begin) - begin);
  }
  throw Failure("cannot " + doing + (reason.empty() ? "" : ": " + reason));
}

void Id::close(const std::string& doing) {
  if (id_ >= 0) check(closer_(std::exchange(id_, -1)), doing);
}

Id create_file(const std::filesystem::path& file) {
  const Id access = unlocked_access();
  return {check(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), "create the file"), H5Fclose};
}

Id open_file(const std::filesystem::path& file, bool writable) {
  const Id access = unlocked_access();
  return {check(H5Fopen(file.c_str(), writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access), "open the file"), H5Fclose};
}

Id create_group(hid_t where, const std::string& name) {
  return {check(H5Gcreate2(where, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), "create " + name), H5Gclose};
}

Id open_group(hid_t where, const std::string& name) {
  return {check(H5Gopen2(where, name.c_str(), H5P_DEFAULT), "find " + name), H5Gclose};
}

bool has_attribute(hid_t where, const std::string& name) { return H5Aexists(where, name.c_str()) > 0; }

bool exists(hid_t where, const std::string& name) { return H5Lexists(where, name.c_str(), H5P_DEFAULT) > 0; }

/// How data sets are made: without the time of day, so that equal runs have equal files.
static Id dataset_properties(const std::string& name) {
  Id properties(check(H5Pcreate(H5P_DATASET_CREATE), "prepare " + name), H5Pclose);
  check(H5Pset_obj_track_times(properties, false), "prepare " + name);
  return properties;
}

/// A data set with its values; null where it has none.
static void write_whole(hid_t where, const std::string& name, hid_t type, hid_t space, const void* values) {
  const Id properties = dataset_properties(name);
  Id dataset(
      check(H5Dcreate2(where, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), "create " + name),
      H5Dclose);
  if (values != nullptr) check(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write " + name);
  dataset.close("write " + name);  // small values are written only now
}

void write_dataset(hid_t where, const std::string& name, hid_t type, const Shape& extent, const void* values) {
  const bool empty = std::find(extent.begin(), extent.end(), 0) != extent.end();
  write_whole(where, name, type, simple_space(extent), empty ? nullptr : values);
}

Id create_growing(hid_t where, const std::string& name, hid_t type, const Shape& row, hsize_t rows_per_chunk,
                  bool compress) {
  Shape now{0}, most{H5S_UNLIMITED}, chunk{rows_per_chunk};
  for (Shape* extent : {&now, &most, &chunk}) extent->insert(extent->end(), row.begin(), row.end());
  const Id space(check(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), "make a data space"),
                 H5Sclose);
  const Id properties = dataset_properties(name);
  check(H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data()), "set the chunks of " + name);
  if (compress) {
    constexpr unsigned kLevel = 4;
    check(H5Pset_shuffle(properties), "set the filters of " + name);
    check(H5Pset_deflate(properties, kLevel), "set the filters of " + name);
    check(H5Pset_fletcher32(properties), "set the filters of " + name);
  }
  return {check(H5Dcreate2(where, name.c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT), "create " + name),
          H5Dclose};
}

Id open_dataset(hid_t where, const std::string& name) {
  return {check(H5Dopen2(where, name.c_str(), H5P_DEFAULT), "find " + name), H5Dclose};
}

Shape shape(hid_t dataset) {
  const Id space(check(H5Dget_space(dataset), "look at a data set"), H5Sclose);
  Shape extent(static_cast<std::size_t>(check(H5Sget_simple_extent_ndims(space), "look at a data set")));
  check(H5Sget_simple_extent_dims(space, extent.data(), nullptr), "look at a data set");
  return extent;
}

void append_row(hid_t dataset, hid_t type, const void* values) {
  Shape extent = shape(dataset);
  const hsize_t row = extent.at(0)++;
  check(H5Dset_extent(dataset, extent.data()), "lengthen a data set");
  const auto [file_space, memory_space] = row_spaces(dataset, row);
  check(H5Dwrite(dataset, type, memory_space, file_space, H5P_DEFAULT, values), "append to a data set");
}

void read_row(hid_t dataset, hid_t type, hsize_t row, void* values) {
  const auto [file_space, memory_space] = row_spaces(dataset, row);
  check(H5Dread(dataset, type, memory_space, file_space, H5P_DEFAULT, values), "read a row");
}

void write_attribute(hid_t where, const std::string& name, const std::string& value) {
  put_attribute(where, name, text_type(false, value.size()), scalar_space(), value.empty() ? "" : value.data());
}

void write_attribute(hid_t where, const std::string& name, const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  pointers.reserve(values.size());
  for (const auto& value : values) pointers.push_back(value.c_str());
  put_attribute(where, name, text_type(true, 0), simple_space({values.size()}), pointers.data());
}

void write_free_text_attribute(hid_t where, const std::string& name, const std::string& value) {
  const char* text = value.c_str();
  put_attribute(where, name, text_type(true, 0), scalar_space(), &text);
}

void write_unit(hid_t dataset, const std::string& unit) { write_free_text_attribute(dataset, "unit", unit); }

void write_provenance(hid_t file, const Provenance& provenance) {
  if (provenance.run_id.empty()) return;
  write_free_text_attribute(file, "run_id", provenance.run_id);
  write_attribute(file, "seed", H5T_NATIVE_UINT64, {}, &provenance.seed);
  write_free_text_attribute(file, "shaken_version", version());
}

Provenance read_provenance(hid_t file) {
  if (!has_attribute(file, "run_id")) return {};
  Provenance provenance;
  {
    const Id attribute(check(H5Aopen(file, "run_id", H5P_DEFAULT), "find run_id"), H5Aclose);
    const Id type = text_type(true, 0);
    char* text = nullptr;
    check(H5Aread(attribute, type, &text), "read run_id");
    provenance.run_id = text;
    check(H5free_memory(text), "read run_id");
  }
  read_attribute(file, "seed", H5T_NATIVE_UINT64, &provenance.seed);
  return provenance;
}

void write_attribute(hid_t where, const std::string& name, hid_t type, const Shape& extent, const void* values) {
  put_attribute(where, name, type, extent.empty() ? scalar_space() : simple_space(extent), values);
}

void read_attribute(hid_t where, const std::string& name, hid_t type, void* value) {
  const Id attribute(check(H5Aopen(where, name.c_str(), H5P_DEFAULT), "find " + name), H5Aclose);
  const Id space(check(H5Aget_space(attribute), "look at " + name), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1) throw Failure("cannot read " + name + ": it is not a single number");
  check(H5Aread(attribute, type, value), "read " + name);
}

std::string read_text_attribute(hid_t where, const std::string& name) {
  const Id attribute(check(H5Aopen(where, name.c_str(), H5P_DEFAULT), "find " + name), H5Aclose);
  const Id type(check(H5Aget_type(attribute), "look at " + name), H5Tclose);
  const Id space(check(H5Aget_space(attribute), "look at " + name), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || H5Sget_simple_extent_npoints(space) != 1) {
    throw Failure("cannot read " + name + ": it is not a text of fixed length");
  }
  std::string value(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, value.data()), "read " + name);
  return value.substr(0, value.find('\0'));
}

void write_string(hid_t where, const std::string& name, const std::string& value) {
  write_whole(where, name, text_type(false, value.size()), scalar_space(), value.data());
}

std::string read_string(hid_t where, const std::string& name) {
  const Id dataset = open_dataset(where, name);
  const Id type(check(H5Dget_type(dataset), "look at " + name), H5Tclose);
  const Id space(check(H5Dget_space(dataset), "look at " + name), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || H5Sget_simple_extent_npoints(space) != 1) {
    throw Failure("cannot read " + name + ": it is not a string of fixed length");
  }
  std::string value(H5Tget_size(type), '\0');
  check(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()), "read " + name);
  value.erase(value.find_last_not_of('\0') + 1);
  return value;
}

}  // namespace shaken::run::hdf5
