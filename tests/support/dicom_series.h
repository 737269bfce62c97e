#pragma once

#include <fmt/format.h>
#include <gdcm-3.0/gdcmAttribute.h>
#include <gdcm-3.0/gdcmImageWriter.h>
#include <gdcm-3.0/gdcmTrace.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptrial::test {

/// A CT, by the axes of the patient (LPS).
struct DicomSeries {
  std::array<int, 3> size{1, 1, 1};                   // columns, rows, slices
  Eigen::Vector3d step{1.0, 1.0, 1.0};                // > 0 [mm]
  Eigen::Vector3d origin{Eigen::Vector3d::Zero()};    // middle of the first voxel [mm]
  Eigen::Matrix3d axes{Eigen::Matrix3d::Identity()};  // columns: of columns, rows, slices
  std::string uid{"1.2.3"};                           // of the series
  std::function<int(int, int, int)> value;            // of a voxel [HU]
};

/// A slice as a scanner writes it: stored numbers are Hounsfield units and 1024.
inline void write_dicom_slice(const std::filesystem::path& file, const DicomSeries& series, int k) {
  gdcm::Trace::WarningOff();
  gdcm::ImageWriter writer;
  gdcm::Image& image = writer.GetImage();
  image.SetNumberOfDimensions(2);
  const unsigned dimensions[2] = {static_cast<unsigned>(series.size[0]),
                                  static_cast<unsigned>(series.size[1])};
  image.SetDimensions(dimensions);
  image.SetPixelFormat(gdcm::PixelFormat(gdcm::PixelFormat::UINT16));
  image.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  image.SetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
  image.SetSlope(1.0);
  image.SetIntercept(-1024.0);
  image.SetSpacing(0, series.step.x());
  image.SetSpacing(1, series.step.y());
  const Eigen::Vector3d place = series.origin + k * series.step.z() * series.axes.col(2);
  for (unsigned i = 0; i < 3; ++i) {
    image.SetOrigin(i, place[i]);
  }
  const Eigen::Matrix<double, 3, 2> cosines = series.axes.leftCols<2>();
  image.SetDirectionCosines(cosines.data());
  std::vector<std::uint16_t> pixels;
  for (int j = 0; j < series.size[1]; ++j) {
    for (int i = 0; i < series.size[0]; ++i) {
      pixels.push_back(static_cast<std::uint16_t>(series.value(i, j, k) + 1024));
    }
  }
  gdcm::DataElement data(gdcm::Tag(0x7fe0, 0x0010));
  data.SetByteValue(reinterpret_cast<const char*>(pixels.data()),
                    static_cast<unsigned>(pixels.size() * sizeof(std::uint16_t)));
  image.SetDataElement(data);
  gdcm::DataSet& set = writer.GetFile().GetDataSet();
  gdcm::Attribute<0x0008, 0x0060> modality;
  modality.SetValue("CT");
  set.Insert(modality.GetAsDataElement());
  gdcm::Attribute<0x0008, 0x0016> kind;
  kind.SetValue("1.2.840.10008.5.1.4.1.1.2");  // CT image
  set.Insert(kind.GetAsDataElement());
  gdcm::Attribute<0x0020, 0x000e> uid;
  uid.SetValue(series.uid.c_str());
  set.Insert(uid.GetAsDataElement());
  writer.SetFileName(file.c_str());
  if (!writer.Write()) {
    throw std::runtime_error(fmt::format("{}: gdcm cannot write it", file.string()));
  }
}

/// One file for each slice in a new folder.
inline void write_dicom(const std::filesystem::path& folder, const DicomSeries& series) {
  std::filesystem::create_directories(folder);
  for (int k = 0; k < series.size[2]; ++k) {
    write_dicom_slice(folder / fmt::format("slice-{:03}.dcm", k), series, k);
  }
}

}  // namespace haptrial::test
