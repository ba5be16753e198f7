// Rational numbers for the exact oracle, which never rounds: those of GMP. Every finite double and every int
// converts to one; convert_to<double>() rounds towards zero.
#pragma once

#include <boost/multiprecision/eigen.hpp>
#include <boost/multiprecision/gmp.hpp>

namespace buoyancy {

// Without expression templates: templated kernels and Eigen expect that a product of two numbers is one.
using Rational =
    boost::multiprecision::number<boost::multiprecision::gmp_rational, boost::multiprecision::et_off>;

}  // namespace buoyancy
