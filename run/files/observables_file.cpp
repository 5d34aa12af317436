#include "run/files/observables_file.h"

#include "base/files.h"
#include "run/files/content_hash.h"
#include "run/files/hdf5.h"
#include "run/files/unit_of_name.h"

namespace shaken::run {
namespace {

void write_arrays(const std::filesystem::path& file, const Observables& arrays, const Provenance& provenance) {
  hdf5::Id out = hdf5::create_file(file);
  hdf5::write_provenance(out, provenance);
  const hdf5::Id links(hdf5::check(H5Pcreate(H5P_LINK_CREATE), "prepare groups"), H5Pclose);
  hdf5::check(H5Pset_create_intermediate_group(links, 1), "prepare groups");
  for (const auto& [path, values] : arrays) {
    const std::size_t slash = path.find_last_of('/');
    const std::string folder = path.substr(0, slash);
    if (slash != std::string::npos && slash > 0 && !hdf5::exists(out, folder)) {
      const hdf5::Id group(
          hdf5::check(H5Gcreate2(out, folder.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), "create " + folder), H5Gclose);
    }
    hdf5::write_dataset(out, path, H5T_NATIVE_DOUBLE, {values.size()}, values.data());
    hdf5::write_unit(hdf5::open_dataset(out, path), unit_of_name(path));
  }
  hdf5::check(H5Fflush(out, H5F_SCOPE_GLOBAL), "write the file");
  out.close("finish the file");
}

/// Visits links and collects the arrays; what is not an array of numbers of one dimension is left out.
herr_t collect(hid_t root, const char* name, const H5O_info_t* info, void* context) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  try {
    const hdf5::Id dataset = hdf5::open_dataset(root, name);
    const hdf5::Id type(hdf5::check(H5Dget_type(dataset), "look at a data set"), H5Tclose);
    if (hdf5::shape(dataset).size() == 1 && H5Tget_class(type) == H5T_FLOAT) {
      auto& arrays = *static_cast<Observables*>(context);
      arrays[std::string("/") + name] = hdf5::read_vector<double>(dataset, H5T_NATIVE_DOUBLE);
    }
    return 0;
  } catch (const std::exception&) {
    return -1;  // stops the visit; an exception must not pass through HDF5
  }
}

}  // namespace

Result<void> write_observables(const std::filesystem::path& file, const Observables& arrays,
                               const Provenance& provenance) {
  hdf5::initialize();
  UnfinishedFile unfinished(file);
  try {
    write_arrays(unfinished.path(), arrays, provenance);
  } catch (const hdf5::Failure& failure) {
    return Error{file.string() + ": " + failure.what()};
  }
  return unfinished.replace();
}

Result<Observables> read_observables(const std::filesystem::path& file) {
  SHAKEN_TRY(check_content(file));
  hdf5::initialize();
  try {
    const hdf5::Id in = hdf5::open_file(file, false);
    Observables arrays;
    hdf5::check(H5Ovisit2(in, H5_INDEX_NAME, H5_ITER_INC, collect, &arrays, H5O_INFO_BASIC), "read the file");
    return arrays;
  } catch (const hdf5::Failure& failure) {
    return Error{file.string() + ": " + failure.what()};
  }
}

}  // namespace shaken::run
