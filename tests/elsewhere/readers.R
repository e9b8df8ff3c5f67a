# SPDX-License-Identifier: MIT
# What an R user does with gatewalk's files: markovchain, ncdf4.
suppressPackageStartupMessages({library(markovchain); library(ncdf4)})
states <- read.csv("field.states.csv", stringsAsFactors = FALSE)
lines <- read.csv("field.csv", stringsAsFactors = FALSE)
P <- matrix(0, nrow(states), nrow(states), dimnames = list(states$name, states$name))
P[cbind(lines$from, lines$to)] <- lines$probability
chain <- new("markovchain", transitionMatrix = P, name = "field")
absorbed <- absorptionProbabilities(chain)
for (end in states$name[states$ending != ""])
  if (end %in% colnames(absorbed)) cat("absorbed", end, sprintf("%.17g", absorbed[1, end]), "\n")

file <- nc_open("p.nc")
row <- ncvar_get(file, "count_row") + 1
column <- ncvar_get(file, "count_column") + 1
count <- ncvar_get(file, "count")
name <- trimws(ncvar_get(file, "state_name"))
M <- matrix(0, length(name) - 1, length(name), dimnames = list(name[-length(name)], name))
M[cbind(row, column)] <- count
stopifnot(all(rowSums(M) == ncvar_get(file, "trials")))
gate <- new("markovchain", transitionMatrix = rbind(M / rowSums(M), trapped = c(rep(0, length(name) - 1), 1)))
stopifnot("trapped" %in% absorbingStates(gate))
cat("counts", sum(count), "\n")
cat("name", name[3], "\n")
