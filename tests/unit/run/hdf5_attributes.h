#pragma once

#include <hdf5.h>

#include <string>

namespace shaken::run {

/// A text of any length that stands at `path`, or "" if there is none.
inline std::string hdf5_text_attribute(hid_t file, const std::string& path, const std::string& name) {
  if (H5Aexists_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return "";
  const hid_t attribute = H5Aopen_by_name(file, path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  std::string text;
  char* read = nullptr;
  if (H5Tis_variable_str(type) > 0 && H5Aread(attribute, type, &read) >= 0) {
    text = read;
    H5free_memory(read);
  }
  H5Tclose(type);
  H5Aclose(attribute);
  return text;
}

}  // namespace shaken::run
