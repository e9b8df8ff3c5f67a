# SPDX-License-Identifier: MIT
# chain.R FOLDER: walks by the package markovchain on the 3 x 3 field that chain_bench wrote, as lines of
# task,tool,field,seconds,walks,difference,floor (see chain_scipy.py). Not on 9 x 9: its class is a dense
# matrix, 7209 states take minutes to construct.
suppressMessages({library(Matrix); library(markovchain)})
folder <- commandArgs(trailingOnly = TRUE)[1]
gates <- 13; side <- 3; cells <- side^2; walks <- 2000
p <- as.matrix(readMM(file.path(folder, sprintf("chain_%d.mtx", side))))
inputs <- nrow(p) / cells - 2
start <- side %/% 2 * inputs + scan(file.path(folder, "start.txt"), quiet = TRUE) + 1
limited <- scan(file.path(folder, sprintf("limited_%d.txt", side)), quiet = TRUE)[1:cells]

names <- as.character(seq_len(nrow(p)))
built <- system.time(
  chain <- new("markovchain", transitionMatrix = p, states = names))[["elapsed"]]
set.seed(1)
took <- system.time(
  last <- replicate(walks, rmarkovchain(n = gates - 1, object = chain, t0 = names[start])[gates - 1]))[["elapsed"]]
# Whoever would leave the 13th gate is cut off in it, so 12 moves say where a walk ends.
state <- as.integer(last) - 1
cell <- ifelse(state < cells * inputs, state %/% inputs, (state - cells * inputs) %% cells)
seen <- tabulate(cell + 1, cells) / walks
cat(sprintf("walks,R markovchain rmarkovchain,3x3,%.6g,%d,%.3g,%.3g\n", took, walks,
            0.5 * sum(abs(seen - limited)), 0.5 * sum(sqrt(2 * limited * (1 - limited) / (pi * walks)))))
cat(sprintf("prepare,R markovchain new,3x3,%.6g,,,\n", built))
