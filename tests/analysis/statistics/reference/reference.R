# Collects the answers of a script and writes them, 17 digits each:
#
#   source("reference.R")
#   procedure("One-way ANOVA", "aov")           # names without commas
#   answer("unequal", f = 12.3, p = 0.01)       # a vector v becomes v.1, v.2, ...
#   finish()
#
# Rscript NAME.R writes NAME.csv beside the script, Rscript NAME.R FILE writes FILE.
lines <- character()
calls <- character()
current <- ""

procedure <- function(name, call) {
  current <<- name
  calls <<- c(calls, sprintf("@ %s | %s", name, call))
}

answer <- function(case, ...) {
  for (name in names(list(...))) {
    values <- as.numeric(list(...)[[name]])
    stopifnot(all(is.finite(values)))
    names <- if (length(values) == 1) name else paste0(name, ".", seq_along(values))
    lines <<- c(lines, sprintf("%s,%s,%s,%.17g", current, case, names, values))
  }
}

data_set <- function(name) {
  read.csv(file.path("data", paste0(name, ".csv")), stringsAsFactors = TRUE)
}

finish <- function() {
  script <- sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE))
  file <- c(commandArgs(TRUE), sub("R$", "csv", script))[1]
  packages <- setdiff(c("stats", .packages()), c("graphics", "grDevices", "utils", "datasets",
                                                 "methods", "base"))
  versions <- c(R.version.string,
                sapply(packages, function(p) paste("package", p, packageVersion(p))))
  writeLines(c(paste("#", versions), calls, "procedure,case,quantity,value", lines), file)
}
