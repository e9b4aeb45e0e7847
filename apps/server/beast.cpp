// SPDX-License-Identifier: Apache-2.0
// Non-template parts of Boost.Asio and Boost.Beast, compiled once.
#include <utility>  // Boost.Asio 1.74 lacks it

#include <boost/asio/impl/src.hpp>
#include <boost/beast/src.hpp>
