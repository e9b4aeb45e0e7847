// SPDX-License-Identifier: Apache-2.0
// The parts of Boost.Asio and Boost.Beast that are no templates, compiled once.
#include <utility>  // Boost.Asio 1.74 lacks it

#include <boost/asio/impl/src.hpp>
#include <boost/beast/src.hpp>
