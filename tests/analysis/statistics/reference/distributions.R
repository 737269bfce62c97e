# Tails and quantiles, near the middle and far out, at degrees of freedom around and beyond 30.
source("reference.R")

t <- c(-8, -2.5, -0.3, 0, 0.01, 0.7, 1.96, 4.2, 11, 40)
df <- c(1, 2.94, 5, 11, 22, 29.5, 31, 47.3, 100, 574, 861)
p <- c(1e-10, 1e-4, 0.005, 0.025, 0.3, 0.5, 0.6, 0.9, 0.975, 0.9995, 1 - 1e-9)
f <- c(1e-4, 0.2, 1, 2.7, 9, 60, 400)
numerator <- c(1, 1.37, 2, 4, 8, 30)
x <- c(1e-3, 0.4, 2, 7, 31, 250)

procedure("Student's t: upper tail", "pt")
for (d in df) answer(paste("df", d), p = pt(t, d, lower.tail = FALSE))
procedure("Student's t: quantile", "qt")
for (d in df) answer(paste("df", d), t = qt(p, d))
procedure("F: upper tail", "pf")
for (n in numerator) for (d in df) {
  answer(paste("df", n, "and", d), p = pf(f, n, d, lower.tail = FALSE))
}
procedure("Normal: upper tail", "pnorm")
answer("z", p = pnorm(t, lower.tail = FALSE))
procedure("Normal: quantile", "qnorm")
answer("p", z = qnorm(p))
procedure("Chi squared: upper tail", "pchisq")
for (d in c(1, 2, 5, 9, 31, 100)) answer(paste("df", d), p = pchisq(x, d, lower.tail = FALSE))
finish()
