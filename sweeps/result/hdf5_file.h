// SPDX-License-Identifier: MIT
// HDF5 calls that results need beside NetCDF: where values lie in the file.
#pragma once

#include <hdf5/serial/hdf5.h>

#include <string>

namespace wholehand::sweeps {

// An HDF5 identifier that closes itself.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Negative if the file cannot be opened. Prints nothing, now or at later failures. HDF5's own lock is unnecessary under the result's, and not every
// file system supports it.
inline hid_t open_hdf5(const std::string& path, unsigned mode) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);
  return H5Fopen(path.c_str(), mode, access);
}

}  // namespace wholehand::sweeps
