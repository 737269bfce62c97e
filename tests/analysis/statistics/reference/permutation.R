# Every arrangement, by combn and expand.grid. Values are whole multiples of 1/64 or whole, so that
# sums are exact and ties are ties.
source("reference.R")

tails <- function(case, found, sums) {
  answer(case, p = c(mean(abs(sums) >= abs(found)), mean(sums <= found), mean(sums >= found)),
         arrangements = length(sums))
}
two <- function(case, a, b) {
  x <- c(a, b) * length(c(a, b))
  x <- x - sum(x) / length(x)  # whole multiples still
  tails(case, sum(x[seq_along(a)]), combn(length(x), length(a), function(i) sum(x[i])))
}
pairs <- function(case, d) {
  signs <- as.matrix(expand.grid(rep(list(c(1, -1)), length(d))))
  tails(case, sum(d), signs %*% d)
}

unequal <- split(data_set("unequal")$value, data_set("unequal")$group)
ties <- split(data_set("ties")$value, data_set("ties")$group)
procedure("Permutation test of two samples", "all of combn")
two("a and d", unequal$a, unequal$d)
two("b and c", unequal$b, unequal$c)
two("ties", ties$a, ties$b)
procedure("Sign-flip test of pairs", "all of expand.grid")
with(data_set("pairs"), pairs("pairs", first - second))
with(head(data_set("tied_pairs"), 13), pairs("ties", first - second))
finish()
