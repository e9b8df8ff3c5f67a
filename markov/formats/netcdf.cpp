// SPDX-License-Identifier: MIT
#include "markov/formats/netcdf.h"

#include <H5Epublic.h>

namespace gatewalk::markov::netcdf {

void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

}  // namespace gatewalk::markov::netcdf
