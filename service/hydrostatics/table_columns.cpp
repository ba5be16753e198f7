#include "service/hydrostatics/table_columns.h"

#include <array>

#include "base/angles.h"

namespace buoyancy::service {
namespace {

constexpr std::array kColumns{TableColumn{"draft", "Draft", "m"},
                              TableColumn{"trim", "Trim", "°"},
                              TableColumn{"displacement_volume", "Displaced volume", "m³"},
                              TableColumn{"displacement_mass", "Displacement", "t"},
                              TableColumn{"lcb", "LCB, centre of buoyancy forward of midship", "m"},
                              TableColumn{"tcb", "TCB, centre of buoyancy to port of the centre plane", "m"},
                              TableColumn{"kb", "KB, centre of buoyancy over the keel", "m"},
                              TableColumn{"lcf", "LCF, centroid of the waterplane forward of midship", "m"},
                              TableColumn{"waterplane_area", "Waterplane area", "m²"},
                              TableColumn{"bm_t", "Transverse BM", "m"},
                              TableColumn{"bm_l", "Longitudinal BM", "m"},
                              TableColumn{"km_t", "Transverse KM", "m"},
                              TableColumn{"km_l", "Longitudinal KM", "m"},
                              TableColumn{"tpc", "TPC, mass that immerses by 1 cm", "t/cm"},
                              TableColumn{"mct1cm", "MCT1cm, moment to change trim by 1 cm", "t m/cm"},
                              TableColumn{"rm1deg", "RM1deg, righting moment at 1 degree", "t m"},
                              TableColumn{"wetted_area", "Wetted surface", "m²"},
                              TableColumn{"lwl", "LWL, length of the waterplane", "m"},
                              TableColumn{"bwl", "BWL, beam of the waterplane", "m"},
                              TableColumn{"cm", "Cm, midship section", ""},
                              TableColumn{"cb_lpp", "Cb on Lpp, block", ""},
                              TableColumn{"cp_lpp", "Cp on Lpp, prismatic", ""},
                              TableColumn{"cwp_lpp", "Cwp on Lpp, waterplane", ""},
                              TableColumn{"cb_lwl", "Cb on LWL, block", ""},
                              TableColumn{"cp_lwl", "Cp on LWL, prismatic", ""},
                              TableColumn{"cwp_lwl", "Cwp on LWL, waterplane", ""}};

}  // namespace

std::span<const TableColumn> table_columns() {
  return kColumns;
}

std::vector<double> values_of(const HydrostaticRow& row) {
  return {row.draft,
          row.trim * kDegreesPerRadian,
          row.volume,
          row.mass * kTonnesPerKilogram,
          row.lcb,
          row.tcb,
          row.kb,
          row.lcf,
          row.waterplane_area,
          row.bm_t,
          row.bm_l,
          row.km_t,
          row.km_l,
          row.mass_per_cm * kTonnesPerKilogram,
          row.moment_per_cm * kTonnesPerKilogram,
          row.moment_per_degree * kTonnesPerKilogram,
          row.wetted_area,
          row.lwl,
          row.bwl,
          row.midship,
          row.on_lpp.block,
          row.on_lpp.prismatic,
          row.on_lpp.waterplane,
          row.on_lwl.block,
          row.on_lwl.prismatic,
          row.on_lwl.waterplane};
}

}  // namespace buoyancy::service
