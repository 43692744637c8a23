#include <hdf5_hl.h>

#include <algorithm>
#include <type_traits>

#include "core/h5/h5_impl.h"

namespace faba {

using namespace h5;

namespace {

constexpr hsize_t kColumnChunk = 1 << 16;  // values

}  // namespace

template <class T>
void H5File::column(const std::string& name, const std::vector<T>& values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  const Handle type(H5Tcopy(std::is_same_v<T, std::string> ? H5T_C_S1 : H5T_NATIVE_UINT32), H5Tclose);
  std::vector<const char*> texts;
  const void* data = values.data();
  if constexpr (std::is_same_v<T, std::string>) {
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    for (const std::string& text : values) texts.push_back(text.c_str());
    data = texts.data();
  } else if (size > 0) {
    const hsize_t chunk = std::min<hsize_t>(size, kColumnChunk);
    H5Pset_chunk(creation, 1, &chunk);
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 1);
    H5Pset_fletcher32(creation);
  }
  const Handle set(H5Dcreate2(impl_->file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                   H5Dclose);
  if (set < 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    impl_->fail(Errc::internal, "write");
}

void H5File::name_dimensions(const std::string& table, const std::vector<std::string>& scales) {
  const Handle set(H5Dopen2(impl_->file, table.c_str(), H5P_DEFAULT), H5Dclose);
  for (unsigned i = 0; i < scales.size(); ++i) {
    const Handle scale(H5Dopen2(impl_->file, scales[i].c_str(), H5P_DEFAULT), H5Dclose);
    if (H5DSis_scale(scale) == 0 && H5DSset_scale(scale, scales[i].c_str()) < 0)
      impl_->fail(Errc::internal, "write");
    if (H5DSattach_scale(set, scale, i) < 0) impl_->fail(Errc::internal, "write");
  }
}

void H5File::attribute(const std::string& object, const std::string& name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle a(H5Acreate_by_name(impl_->file, object.c_str(), name.c_str(), H5T_NATIVE_DOUBLE, space,
                                   H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  if (a < 0 || H5Awrite(a, H5T_NATIVE_DOUBLE, &value) < 0) impl_->fail(Errc::internal, "write");
}

void H5File::attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose), type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(1, value.size()));
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const Handle a(H5Acreate_by_name(impl_->file, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                   H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  if (a < 0 || H5Awrite(a, type, value.c_str()) < 0) impl_->fail(Errc::internal, "write");
}

double H5File::number_attribute(const std::string& object, const std::string& name) const {
  const Handle a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  double value = 0;
  if (a < 0 || H5Aread(a, H5T_NATIVE_DOUBLE, &value) < 0)
    throw Error(Errc::input, impl_->path.string(), fmt::format("numeric attribute \"{}\" not found", name));
  return value;
}

std::string H5File::text_attribute(const std::string& object, const std::string& name) const {
  const Handle a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose);
  if (a >= 0) {
    const Handle type(H5Aget_type(a), H5Tclose);
    std::string value(H5Tget_class(type) == H5T_STRING && !H5Tis_variable_str(type) ? H5Tget_size(type) : 0,
                      '\0');
    if (!value.empty() && H5Aread(a, type, value.data()) >= 0) return value.substr(0, value.find('\0'));
  }
  throw Error(Errc::input, impl_->path.string(), fmt::format("string attribute \"{}\" not found", name));
}

template void H5File::column<std::uint32_t>(const std::string&, const std::vector<std::uint32_t>&);
template void H5File::column<std::string>(const std::string&, const std::vector<std::string>&);

}  // namespace faba
