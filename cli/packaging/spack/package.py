# Copyright gatewalk's authors. SPDX-License-Identifier: MIT

from spack.package import *


class Gatewalk(CMakePackage):
    """Multi-scale Markov chain analysis of locomotion through cluttered obstacles."""

    license("MIT")

    # The source is that of the folder which `spack dev-build` is called in.
    version("main")

    variant("mpi", default=False, description="Share the trials of a run among processes")
    variant("video", default=False, description="Films of runs, maps of terrain from pictures")
    variant("pages", default=False, description="Pages: replays of runs, the report on the paper")

    depends_on("cxx", type="build")
    depends_on("c", type="build", when="+mpi")
    depends_on("cmake@3.25:", type="build")
    depends_on("eigen@3.4:")
    depends_on("suite-sparse")
    depends_on("boost@1.74:+program_options+math")
    depends_on("netcdf-c build_system=cmake")
    depends_on("hdf5")
    depends_on("fmt@9:")
    depends_on("tbb")
    depends_on("highway")
    depends_on("random123")
    depends_on("tomlplusplus")
    depends_on("nlohmann-json")
    depends_on("zlib-api")
    depends_on("libarchive")
    depends_on("mpi", when="+mpi")
    depends_on("cairo", when="+video")
    depends_on("libpng@1.6:", when="+video")

    def cmake_args(self):
        return [
            self.define("BUILD_TESTING", False),
            self.define_from_variant("GATEWALK_MPI", "mpi"),
            self.define_from_variant("GATEWALK_VIDEO", "video"),
            self.define_from_variant("GATEWALK_PAGES", "pages"),
        ]
